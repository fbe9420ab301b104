// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/model/scaled.hpp"
#include "kelpie/model/steady_part.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "kelpie/online/committee.hpp"
#include "kelpie/online/conformal.hpp"
#include "kelpie/online/disturbance.hpp"

namespace kelpie {

/// What surrounds the predictions of an axis, in the target's unit.
struct IntervalState {
  bool ready = false;                 ///< whether a model is in service
  double half_width = 0.0;            ///< of the interval
  double corrected_half_width = 0.0;  ///< of that with the disturbance
  Disturbance disturbance{};

  /// A value with all that is known around it, `ahead_s` [s] after the last sample.
  Prediction prediction(double value, double novelty, double ahead_s) const;
};

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
  IntervalState interval_state() const;                            ///< A copy.
  double half_width() const { return interval_.half_width(); }     ///< Of the interval, likewise.
  SteadyModel steady() const { return steady_ ? steady_->model() : SteadyModel{}; }

 private:
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
