// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/stored_past_model.hpp"
#include "kelpie/online/committee.hpp"
#include "kelpie/online/conformal.hpp"
#include "kelpie/online/disturbance.hpp"
#include "model/scaled.hpp"
#include "model/snapshot.hpp"
#include "model/steady_part.hpp"

namespace kelpie {

/// One axis of a DynamicsModel: the learner behind its scale, the interval around its predictions,
/// the disturbance with an interval of its own, and, where it is known which velocity the target
/// accelerates, the steady part that rollouts need. None of these changes predictions.
class DynamicsAxis final : public Scaled {
 public:
  /// The scaling is given, or comes from the first samples. Throws InputError on settings of the
  /// axis that don't validate. Requires valid shared settings, inputs <= kMostInputs, and terms,
  /// scaling and steady part made for these inputs.
  DynamicsAxis(std::size_t inputs, const SharedSettings& shared, const OnlineSvrSettings& settings,
               const TermSet& terms, std::optional<AxisScaling> scaling = {},
               std::optional<SteadyPart> steady = {});

  void limit(const Budget& budget) { learner_.limit(budget); }  ///< Committee::limit().

  Decision update(std::span<const double> x, double y, double t) override;

  /// Before there is a scale, everything is new.
  Prediction assess(std::span<const double> x) const override { return assess(x, 0.0); }

  /// The same of a sample `ahead_s` after the last one learned. Of a later sample than the next no
  /// interval is promised with the disturbance.
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

  /// A copy for a TrainedModel: with a steady part, without a disturbance. Requires a model in
  /// service. Allocates.
  Snapshot trained(std::string name) const;

  std::vector<Coefficient> coefficients() const override;
  std::vector<MemberShare> members() const override { return learner_.members(); }

  /// The past models that the learner keeps, in the units of the log. Allocates.
  std::vector<StoredPastModel> past_models() const;

  /// Gives the learner past models to keep, as soon as the scale is known. Requires that nothing
  /// has been learned yet, room for them, and as many inputs. Allocates.
  void set_past_models(std::vector<StoredPastModel> models);

  /// Goes on where a trained model stands, at the time `t` [s] (Committee::resume_from). Requires
  /// that nothing has been learned yet, no scaling given, and a scaling and functions of as many
  /// inputs and terms. Allocates.
  void resume_from(const AxisScaling& scaling, const FunctionMix& said, double t);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// The committee that these settings ask for.
  static Committee::Plan committee_plan(const SharedSettings& shared, const TermSet& terms);

  const Committee& committee() const { return learner_; }          ///< On scaled samples.
  const AdaptiveSvr& svr() const { return learner_.learner(); }    ///< The paper's learner in it.
  const Disturbance& disturbance() const { return disturbance_; }  ///< In the target's unit.

 private:
  void score(Decision& decision, double y, double t);
  void fit_steady_part(const Decision& decision, std::span<const double> x, double y, double t);
  Committee& learner() override { return learner_; }
  const Committee& learner() const override { return learner_; }
  void scale_found() override;
  RescaleStatus rescale(const SampleMap& map) override;

  Committee learner_;
  std::vector<StoredPastModel> awaited_;  ///< what it is to keep once there is a scale
  std::optional<SteadyPart> steady_;
  ConformalInterval interval_;  ///< in the target's own unit
  Disturbance disturbance_;
  ConformalInterval corrected_interval_;  ///< around predictions with the disturbance
};

}  // namespace kelpie
