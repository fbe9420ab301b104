// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie {

/// Names of the axes 0 to 5.
inline constexpr std::array<std::string_view, 6> kAxisTexts{"surge", "sway",  "heave",
                                                            "roll",  "pitch", "yaw"};

/// The axis of a velocity by its name, in any case: 0 to 5 for u, v, w, p, q, r; surge, sway, heave
/// (also surge_velocity, surge_speed, …); roll_rate, pitch_rate, yaw_rate; Vx, Vy, Vz, v_x, …; a
/// component of a twist or of a velocity (twist.linear.x, twist.twist.angular.z,
/// angular_velocity.z). Empty for other names, such as roll, pitch and yaw, possibly angles.
std::optional<std::size_t> velocity_axis(std::string_view name);

/// The names that a velocity may have whose derivative is called `name`: of "udot" and "u_dot" it
/// is u, of "du" as well; "ddot" gives d and dot. Empty for other names.
std::vector<std::string_view> differentiated(std::string_view name);

/// Number of velocities at the start of the inputs, by velocity_axis().
std::size_t named_velocities(std::span<const std::string> inputs);

/// Finds the inputs whose derivatives are the targets, in the order of the targets:
///
///     auto     the first inputs, if velocity_axis() knows as many names as there are targets;
///              otherwise empty
///     none     empty
///     u,v,r    columns by name
/// Throws InputError (field "states") on an unknown or repeated name and on a wrong number.
std::vector<std::size_t> find_states(std::string_view specification,
                                     std::span<const std::string> inputs, std::size_t targets);

}  // namespace kelpie
