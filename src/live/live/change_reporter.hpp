// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/stream/stream_plan.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "live/output.hpp"

namespace kelpie::live {

/// Reports a model in service, and changes of the vehicle: by axis as soon as they are found, with
/// their cause as soon as the diagnosis has named it.
class ChangeReporter {
 public:
  /// `was_ready`: a model was in service before the first sample.
  ChangeReporter(const StreamPlan& plan, bool was_ready) : plan_(&plan), was_ready_(was_ready) {}

  /// Requires that the model has just learned the sample at `t` [s], number `learned`.
  void report(const DynamicsModel& model, std::size_t learned, double t, Output& output);

  const std::string& vehicle() const { return vehicle_; }  ///< Last finding; empty: none.

 private:
  bool update_vehicle(const DynamicsModel& model);

  const StreamPlan* plan_;
  bool was_ready_;
  std::string vehicle_;
  double told_s_ = -std::numeric_limits<double>::infinity();  // Finding::told_s of the last finding
  bool settled_ = false;
};

}  // namespace kelpie::live
