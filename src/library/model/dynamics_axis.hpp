// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/stored_past_model.hpp"
#include "learner/committee.hpp"
#include "learner/conformal.hpp"
#include "learner/disturbance.hpp"
#include "model/command_gain.hpp"
#include "model/scaled.hpp"
#include "model/snapshot.hpp"
#include "model/uncertainty.hpp"

namespace kelpie {

/// One axis of a DynamicsModel: the learner with its scale, the interval around predictions, and
/// the disturbance with an interval of its own. Interval and disturbance leave predictions
/// unchanged.
class DynamicsAxis final : public Scaled {
 public:
  /// Without a scaling, the first samples give it. Throws InputError on settings of the axis that
  /// don't validate. Requires valid shared settings, inputs <= kMostInputs, and terms and scaling
  /// of these inputs.
  DynamicsAxis(std::size_t inputs, const SharedSettings& shared, const OnlineSvrSettings& settings,
               const TermSet& terms, std::optional<AxisScaling> scaling = {});

  /// Scaled::expect(); errors may be as large as these samples.
  void expect(const ThinnedRows& samples, std::size_t first) {
    Scaled::expect(samples, first);
    learner_.forget_usual_errors();
  }

  void limit(const Budget& budget) { learner_.limit(budget); }  ///< Committee::limit().

  Decision update(std::span<const double> x, double y, double t) override;

  /// The prediction of the next sample. Before the scale is known, the novelty is 1.
  Prediction assess(std::span<const double> x) const override { return assess(x, 0.0); }

  /// The prediction of a sample `ahead_s` [s] after the last learned sample. The interval with the
  /// disturbance is finite for the next sample only.
  Prediction assess(std::span<const double> x, double ahead_s) const;

  /// The prediction and its gradient by the raw inputs; a mean of the targets and zeros without a
  /// model in service.
  double predict_with_gradient(std::span<const double> x, std::span<double> gradient) const;

  /// A copy of the model in service with all its uncertainty, and room to refresh() it for good.
  /// Allocates.
  Snapshot snapshot() const;

  /// Brings scaling, function, known places and uncertainty of a copy up to date. Requires a model
  /// in service, and a copy of this axis. Cost O(n inputs) for n samples. Allocates nothing.
  void refresh(Snapshot& copy) const;

  /// A copy for a TrainedModel, without a disturbance. Requires a model in service. Allocates.
  Snapshot trained(std::string name) const;

  /// The vehicle has changed. `gains`: all that was learned holds for the commands times these
  /// factors; if empty, Committee::shift() by a step of the coefficients of the first terms, the
  /// last number of the term 1 [target unit per unit of the term].
  void apply_change(std::span<const CommandGain> gains, std::span<const double> step,
                    const Decision& news);

  std::vector<Coefficient> coefficients() const override;
  std::vector<MemberShare> members() const override { return learner_.members(); }

  /// The past models of the learner, in the units of the log. Allocates.
  std::vector<StoredPastModel> past_models() const;

  /// Gives the learner past models, once the scale is known. Requires that nothing has been learned
  /// yet, enough room, and the same number of inputs. Allocates.
  void set_past_models(std::vector<StoredPastModel> models);

  /// Begins with coefficients of the terms known beforehand, the last number of the term 1, once
  /// the scale is known [target unit per unit of the term]. Requires that nothing has been learned
  /// yet.
  void expect_vehicle(std::span<const double> coefficients);

  /// Continues from a trained model at the time `t` [s] (Committee::resume_from). Requires that
  /// nothing has been learned yet, no given scaling, and the same inputs and terms. Allocates.
  void resume_from(const AxisScaling& scaling, const FunctionMix& said, double t);

  void visit(Archive& archive);  ///< core/archive.hpp

  const Committee& committee() const { return learner_; }        ///< On scaled samples.
  const AdaptiveSvr& svr() const { return learner_.learner(); }  ///< The paper's learner.
  const Disturbance& disturbance() const { return uncertainty_.disturbance(); }

 private:
  ShortVector<kMostTerms + 1> scaled_weights(std::span<const double> coefficients) const;
  Committee& learner() override { return learner_; }
  const Committee& learner() const override { return learner_; }
  void scale_found() override;
  RescaleStatus rescale(const SampleMap& map) override;

  Committee learner_;
  std::vector<StoredPastModel> awaited_;  ///< for the learner, until the scale is known
  std::vector<double> expected_;          ///< coefficients, until the scale is known
  Uncertainty uncertainty_;
};

/// The committee of these settings.
Committee::Plan committee_plan(const SharedSettings& shared, const TermSet& terms);

}  // namespace kelpie
