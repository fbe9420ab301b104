// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/settings.hpp"
#include "kelpie/svr/online_svr.hpp"
#include "model/first_scale.hpp"
#include "model/model_axis.hpp"
#include "model/uncertainty.hpp"

namespace kelpie {

/// An axis learned by the paper's learner alone (`learner = svr`): a scale, an OnlineSvr, and
/// interval and disturbance around its predictions, which leave predictions unchanged. Neither
/// follows changes of the vehicle nor keeps past vehicles.
class SvrAxis final : public ModelAxis {
 public:
  /// Without a scaling, the first samples give the scale. Throws InputError on settings of the axis
  /// that don't validate. Requires valid shared settings, inputs <= kMostInputs, and terms and
  /// scaling of these inputs.
  SvrAxis(std::size_t inputs, const SharedSettings& shared, const OnlineSvrSettings& settings,
          const TermSet& terms, std::optional<AxisScaling> scaling);

  /// Memory in bytes.
  static std::size_t bytes(std::size_t inputs, std::size_t terms,
                           const OnlineSvrSettings& settings);

 private:
  std::unique_ptr<ModelAxis> clone() const override { return std::make_unique<SvrAxis>(*this); }
  Decision update(std::span<const double> x, double y, double t) override;
  void limit(const Budget& budget) override { learner_.limit(budget); }
  void learn_held_back() override { scale_.learn_held_back(learner_); }
  bool unfinished() const override { return learner_.unfinished(); }
  bool trusted_last() const override { return true; }

  double predict(std::span<const double> x) const override { return scale_.predict(learner_, x); }
  using ModelAxis::assess;
  Prediction assess(std::span<const double> x) const override { return assess(x, 0.0); }
  Prediction assess(std::span<const double> x, double ahead_s) const override;
  double predict_with_gradient(std::span<const double> x,
                               std::span<double> gradient) const override;

  Status status() const override { return scale_.status(learner_); }
  std::vector<Coefficient> coefficients() const override;

  const TermSet& terms() const override { return scale_.terms(); }
  const AxisScaling* scaling() const override { return scale_.scaling(); }
  Snapshot snapshot() const override;
  void refresh(Snapshot& copy) const override;
  Snapshot trained(std::string name) const override;
  FunctionMix function() const;

  void expect_vehicle(std::vector<double> /*coefficients*/) override {}
  /// Throws InputError on any.
  void set_past_models(std::vector<StoredPastModel> models) override;
  /// Learns the support vectors of the first function.
  void resume_from(const Snapshot& trained, double t) override;

  void visit(Archive& archive) override;

  FirstScale scale_;
  OnlineSvr learner_;  ///< of scaled samples
  Uncertainty uncertainty_;
};

}  // namespace kelpie
