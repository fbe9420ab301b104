// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "live/configuration.hpp"

namespace kelpie::ros {

/// Axis of each target's acceleration: 0 to 5 for surge, sway, heave, roll, pitch, yaw. Derived
/// from the integrated velocity, else from the target's name ("udot", "surge_acceleration",
/// "yaw_accel"), else from its field (accel.linear.x, linear_acceleration.x). Empty where unknown,
/// and for a second target of the same axis.
std::vector<std::optional<std::size_t>> acceleration_axes(const live::Configuration& configuration);

}  // namespace kelpie::ros
