// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/stream/stream_plan.hpp"
#include "live/output.hpp"

namespace kelpie::live {

/// Says what a sample brought: a model in service, a change of an axis, what has become of the
/// vehicle.
class ChangeReporter {
 public:
  /// `was_ready`: whether there was a model in service before the first sample.
  ChangeReporter(const StreamPlan& plan, bool was_ready) : plan_(&plan), was_ready_(was_ready) {}

  /// After the model has learned the sample at `t` [s], the `learned`-th.
  void report(const DynamicsModel& model, std::size_t learned, double t, Output& output);

  /// What was said of the vehicle last; empty: nothing.
  const std::string& vehicle() const { return vehicle_; }

 private:
  void report_vehicle(const DynamicsModel& model, double t, Output& output);

  const StreamPlan* plan_;
  bool was_ready_;
  std::string vehicle_;
  double told_s_ = -std::numeric_limits<double>::infinity();  // Finding::told_s of that
  bool settled_ = false;
};

}  // namespace kelpie::live
