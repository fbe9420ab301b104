// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace kelpie {

// Names of signals with one meaning: the velocities of velocity_axis(), and the thruster speeds of
// `kelpie identify`. Drafts of [log] also know less certain names (src/logs/log/known_roles.cpp).

/// The axis (0 to 5: u, v, w, p, q, r) of a velocity by its name in lower case.
std::optional<std::size_t> certain_velocity_axis(std::string_view name);

/// Whether a column is a thruster's speed by its name.
bool names_thruster(std::string_view column);

/// Pulse at rest of servos and motor controllers [µs]: the middle of 1000 to 2000.
inline constexpr double kNeutralPulseUs = 1500.0;

/// Whether commands of this range can be pulses of servos and motor controllers [µs].
inline bool are_servo_pulses(double lowest, double highest) {
  return lowest >= 800.0 && highest <= 2200.0;
}

/// The same, to both sides of rest: thrust of both directions.
inline bool are_pulses_about_rest(double lowest, double highest) {
  return are_servo_pulses(lowest, highest) && lowest < kNeutralPulseUs && highest > kNeutralPulseUs;
}

}  // namespace kelpie
