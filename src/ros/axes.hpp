// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "live/configuration.hpp"

namespace kelpie::ros {

/// Which acceleration of a body every target is, by the velocity that it is the derivative of, by
/// its own name ("udot", "surge_acceleration", "yaw_accel") or by the field that it comes from
/// (accel.linear.x, linear_acceleration.x): 0 to 5 for surge, sway, heave, roll, pitch, yaw. None
/// where nothing tells, and for the second target of one axis.
std::vector<std::optional<std::size_t>> acceleration_axes(const live::Configuration& configuration);

}  // namespace kelpie::ros
