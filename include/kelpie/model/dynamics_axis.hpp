// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/model/remembered_model.hpp"
#include "kelpie/model/scaled.hpp"
#include "kelpie/model/steady_part.hpp"
#include "kelpie/online/committee.hpp"
#include "kelpie/online/conformal.hpp"

namespace kelpie {

/// One axis of a DynamicsModel: the learner behind its scale, the interval around its predictions,
/// and, where it is known which velocity the target accelerates, the steady part that rollouts
/// need. The last two do not change predictions.
class DynamicsAxis final : public Scaled {
 public:
  /// The scaling is given, or comes from the first samples. Throws InputError on settings of the
  /// axis that don't validate. Requires valid shared settings, inputs <= kMostInputs, and terms,
  /// scaling and steady part made for these inputs.
  DynamicsAxis(std::size_t inputs, const SharedSettings& shared, const OnlineSvrSettings& settings,
               const TermSet& terms, std::optional<AxisScaling> scaling = {},
               std::optional<SteadyPart> steady = {});

  Decision update(std::span<const double> x, double y, double t) override;

  /// Before there is a scale, everything is new.
  Prediction assess(std::span<const double> x) const override;

  std::vector<Coefficient> coefficients() const override;
  std::vector<MemberShare> members() const override { return learner_.members(); }

  /// The past models that the learner keeps, in the units of the log. Allocates.
  std::vector<RememberedModel> remembered() const;

  /// Gives the learner past models to keep, as soon as the scale is known. Requires that nothing
  /// has been learned yet, room for them, and as many inputs. Allocates.
  void remember(std::vector<RememberedModel> models);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// The committee that these settings ask for.
  static Committee::Plan committee_plan(const SharedSettings& shared, const TermSet& terms);

  const Committee& committee() const { return learner_; }        ///< On scaled samples.
  const AdaptiveSvr& svr() const { return learner_.learner(); }  ///< The paper's learner in it.
  SteadyModel steady() const { return steady_ ? steady_->model() : SteadyModel{}; }

 private:
  Committee& learner() override { return learner_; }
  const Committee& learner() const override { return learner_; }
  void scale_found() override;
  bool restate(const SampleMap& map) override;

  Committee learner_;
  std::vector<RememberedModel> awaited_;  ///< what it is to keep once there is a scale
  std::optional<SteadyPart> steady_;
  ConformalInterval interval_;  ///< in the target's own unit
};

}  // namespace kelpie
