// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "kelpie/svr/regressor.hpp"

namespace kelpie {

/// All axes of one vehicle, one learner per axis, taught with the same samples: a DynamicsModel, or
/// the baselines that it is compared with (model/axis_list.hpp).
class OnlineModel {
 public:
  /// Called with the number of an axis after the axis has learned the sample, e.g. to take the
  /// time.
  using AxisDone = std::function<void(std::size_t)>;

  virtual ~OnlineModel() = default;

  std::size_t axes() const { return decisions().size(); }

  /// Teaches one sample to every axis in turn; an axis that finds a change of the vehicle then
  /// alerts the others (OnlineRegressor::alert). decisions() tells the outcome. x and y are in the
  /// units of the log, t in seconds. Bad data (a number that isn't finite, a time that steps back)
  /// is no error: the decisions report it. Throws InputError, and learns nothing, on a y of another
  /// size than axes(), on an x of another size than a DynamicsModel has inputs (other learners:
  /// Verdict::invalid), and where another thread uses the model at the same time.
  void update(std::span<const double> x, std::span<const double> y, double t) {
    update(x, y, t, {});
  }
  /// The same, with a call of `done` after each axis.
  virtual void update(std::span<const double> x, std::span<const double> y, double t,
                      const AxisDone& done) = 0;

  /// Learns all samples still held back, once the scale is known: for the end of a log. Without
  /// this call, later updates learn a few held samples each.
  virtual void learn_held_back() = 0;

  /// The outcome of the last update(), one per axis.
  virtual std::span<const Decision> decisions() const = 0;

  /// The learner of an axis, for predictions and status.
  virtual const OnlineRegressor& axis(std::size_t i) const = 0;

 protected:
  OnlineModel() = default;
  OnlineModel(const OnlineModel&) = default;
  OnlineModel& operator=(const OnlineModel&) = default;
};

}  // namespace kelpie
