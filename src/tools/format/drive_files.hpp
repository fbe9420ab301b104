// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/drive_plan.hpp"

namespace kelpie::format {

/// A planned drive with the content of its files: docs/howto/identify.md, "Drive this next".
struct PlannedDrive {
  std::string source;  ///< log
  std::vector<std::string> thrusters{};
  study::DrivePlan plan{};
  study::DriveBounds bounds{};
  double aim = 0.05;   ///< share, or nats
  bool parts = false;  ///< two causes, not parameters
  bool has_scale = false;
  bool six_axes = false;  ///< depth and tilt count
  /// The command of a thruster for a speed of the fit.
  std::function<double(std::size_t thruster, double speed)> command =
      [](std::size_t, double speed) { return speed; };
};

/// Setpoints: t and a command per thruster, which hold until the next row; the last row is at rest.
std::string drive_csv(const PlannedDrive& drive);

/// Bounds, countdown and manoeuvres. Ends in a newline.
std::string drive_json(const PlannedDrive& drive);

/// Whether commands are pulses that rest near 1500 µs and names end in the numbers of different
/// motors, 1 to 12.
bool has_pulses(const PlannedDrive& drive);

/// A Lua script for ArduSub that holds the pulses on the outputs of the motors. Begins whenever the
/// vehicle is armed, not where armed already as the script is loaded, and not without an output for
/// every motor. At the end, and when disarmed, the motors rest; then, as after a pause of the
/// script, the outputs are the autopilot's (ArduPilot, libraries/AP_Scripting: docs/docs.lua,
/// examples/servo_set_get.lua). Requires has_pulses().
std::string drive_lua(const PlannedDrive& drive);

}  // namespace kelpie::format
