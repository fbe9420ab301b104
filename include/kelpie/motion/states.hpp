// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie {

/// The axis that a velocity is along or about by its name, in any case: 0 to 5 for u, v, w, p, q,
/// r; surge, sway, heave (also surge_velocity, surge_speed, …); roll_rate, pitch_rate, yaw_rate;
/// Vx, Vy, Vz, v_x, …; a part of a twist or of a velocity (twist.linear.x, twist.twist.angular.z,
/// angular_velocity.z). None for other names, such as roll, pitch and yaw, which may be angles.
std::optional<std::size_t> velocity_axis(std::string_view name);

/// How many of the first inputs are velocities by their names (velocity_axis).
std::size_t named_velocities(std::span<const std::string> inputs);

/// Which inputs are the velocities that the targets accelerate, one per target in their order:
///
///     auto     the first inputs, where they are velocities by their names and as many as the
///              targets; else none
///     none
///     u,v,r    columns by name
/// Throws InputError (field "states") on a name that is no input, or one named twice, or another
/// number than targets.
std::vector<std::size_t> find_states(std::string_view specification,
                                     std::span<const std::string> inputs, std::size_t targets);

}  // namespace kelpie
