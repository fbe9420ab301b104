// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/decision.hpp"
#include "learner/conformal.hpp"
#include "learner/disturbance.hpp"
#include "model/snapshot.hpp"

namespace kelpie {

/// What surrounds the predictions of an axis, in the target's unit: an interval, the disturbance,
/// and an interval around predictions with the disturbance. Leaves predictions unchanged. Allocates
/// nothing.
class Uncertainty {
 public:
  explicit Uncertainty(double coverage) : interval_(coverage), corrected_interval_(coverage) {}

  /// Surrounds the prediction of a decision and learns from its error; nothing without a model.
  void score(Decision& decision, double y, double t);

  IntervalState intervals() const {
    return {interval_.half_width(), corrected_interval_.half_width(), &disturbance_};
  }
  void refresh(Snapshot& copy) const;  ///< Brings the uncertainty of a copy up to date.

  double half_width() const { return interval_.half_width(); }     ///< Of the interval.
  const Disturbance& disturbance() const { return disturbance_; }  ///< In the target's unit.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  ConformalInterval interval_;
  Disturbance disturbance_;
  ConformalInterval corrected_interval_;
};

}  // namespace kelpie
