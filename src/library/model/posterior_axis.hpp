// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/model/settings.hpp"
#include "model/model_axis.hpp"
#include "model/uncertainty.hpp"
#include "posterior/features.hpp"
#include "posterior/mixture.hpp"
#include "posterior/past_vehicles.hpp"
#include "posterior/posterior.hpp"
#include "posterior/row_screen.hpp"

namespace kelpie {

/// An axis learned by one Posterior (`learner = posterior`): features, posterior, and the model in
/// service, with an interval and the disturbance around its predictions. update() is the way of a
/// sample. Before the first solve, after ten samples, the mean of the targets is in service.
///
/// The model in service is a function of kernels and terms, as of any learner, within the targets
/// seen and a tenth of their range, or within what well-known terms can add up to.
class PosteriorAxis final : public ModelAxis {
 public:
  PosteriorAxis(std::size_t inputs, const SharedSettings& shared, const OnlineSvrSettings& settings,
                const TermSet& terms, std::span<const std::size_t> states);

  /// Memory in bytes.
  static std::size_t bytes(std::size_t inputs, std::size_t terms,
                           const OnlineSvrSettings& settings);

 private:
  std::unique_ptr<ModelAxis> clone() const override {
    return std::make_unique<PosteriorAxis>(*this);
  }
  Decision update(std::span<const double> x, double y, double t) override;
  void alert(double /*since_s*/, bool another) override {
    if (!another) {
      past_.alert();
    }
  }
  void limit(const Budget& budget) override {
    budget_ = budget;
    mixture_.limit(budget);
  }
  void learn_held_back() override;
  bool unfinished() const override { return posterior_.wants_solve() || mixture_.unfinished(); }
  bool trusted_last() const override { return trusted_last_; }

  double predict(std::span<const double> x) const override;
  using ModelAxis::assess;
  Prediction assess(std::span<const double> x) const override { return assess(x, 0.0); }
  Prediction assess(std::span<const double> x, double ahead_s) const override;
  double predict_with_gradient(std::span<const double> x,
                               std::span<double> gradient) const override;

  Status status() const override;
  std::vector<Coefficient> coefficients() const override;
  std::vector<MemberShare> members() const override { return mixture_.members(); }

  const TermSet& terms() const override { return features_.terms(); }
  Snapshot snapshot() const override;
  void refresh(Snapshot& copy) const override;
  Snapshot trained(std::string name) const override;

  void apply_change(std::span<const CommandGain> gains, std::span<const double> step,
                    const Decision& news) override;
  /// The prior's mean: coefficients of the terms, the last of the term 1. What is learned is what
  /// this vehicle leaves. Requires that nothing has been learned yet.
  void expect_vehicle(std::vector<double> coefficients) override;
  /// The vehicles left, and the one in service.
  std::vector<StoredPastModel> past_models() const override;
  void set_past_models(std::vector<StoredPastModel> models) override;
  /// Learns what the function says at the places known, and half-way between these, each a
  /// deviation of the errors above and below: 2,000 rows.
  void resume_from(const Snapshot& trained, double t) override;
  const AxisScaling* scaling() const override { return has_scale_ ? &scaling_ : nullptr; }

  void visit(Archive& archive) override;

  using TermWeights = ShortVector<kMostTerms + 1>;

  static std::size_t centres_of(const OnlineSvrSettings& settings);
  double known(std::size_t feature) const { return prior_.empty() ? 0.0 : prior_[feature]; }
  double expected(std::span<const double> x) const;
  double trust(std::span<const double> x, double t);
  void learn(const RowScreen::Due& due);
  void begin_anew();
  void recall(const PastVehicle& back, Decision& decision);
  void change_scale();
  TermWeights in_scale(TermWeights weights, double bias) const;
  double in_scale(double left) const { return scaling_.target.apply(left + known(0)); }
  void tell_anew(std::span<const double> step, const TermWeights& first, double kept);
  void take_over();
  void serve();
  void assign_members();
  TermWeights step_on_probation() const;
  ValueRange certain_range();
  std::size_t block_length() const;
  void know_centres();

  Features features_;
  Posterior posterior_;  ///< of the targets less what was expected()
  RowScreen screen_;     ///< which rows are learned
  PastVehicles past_;
  std::vector<double> prior_;  ///< the prior's mean of the first features; empty: 0
  AxisScaling scaling_;        ///< of the mixture
  bool has_scale_ = false;     ///< after the first solve
  ValueRange certain_;         ///< of values that the terms were certain of then
  Mixture mixture_;            ///< in service
  KnownPlaces known_;          ///< the centres, for novelty
  Uncertainty uncertainty_;
  double last_s_ = 0.0;  ///< time of the last sample [s]
  double far_s_ = 0.0;   ///< for which velocities have been far away, less those that were not [s]
  bool trusted_last_ = true;
  Tally tally_;
  Budget budget_;
  RoomyVector<double> scratch_;  ///< a number per feature
  std::vector<double> place_;    ///< scratch
};

}  // namespace kelpie
