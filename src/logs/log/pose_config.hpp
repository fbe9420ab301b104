// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "log/dataset.hpp"
#include "log/log_config.hpp"

namespace kelpie::log {

/// The configuration of a table whose poses are `roles.pose`: further signals are `roles.inputs`
/// that are no columns of the pose, or commands by name; the time is `roles.time`, or by name; rows
/// per second as asked for, else as poses come, at most 10. Throws InputError (table, column) on a
/// missing column, a name that tells no part, no time, no command or several readings.
LogConfig pose_config(const Table& table, const Roles& roles);

/// The roles of the sampled columns where the caller names none: all accelerations but pdot and
/// qdot are targets.
void add_pose_targets(const StreamPlan::Pose& pose, Roles& roles);

}  // namespace kelpie::log
