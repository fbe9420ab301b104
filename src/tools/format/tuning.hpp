// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kelpie::format {

/// Assumptions where neither log nor vehicle file tells. Chosen by hand; no measurement recorded.
inline constexpr struct Tuning {
  double most_off_rad = 0.35;    ///< largest angle between a thruster and its axis in the simulator
  double low_centre_m = 0.05;    ///< centre of gravity below the origin
  double roll_over_yaw = 0.35;   ///< inertia and added inertia in roll
  double depth_per_s = 1.0;      ///< rate of the assumed depth controller [rad/s]
  double depth_integral = 0.04;  ///< of its proportional gain at 1 rad/s
  double depth_damping = 1.4;    ///< derivative gain over mass and rate
  double pitch_per_s = 3.0;      ///< rate of the assumed pitch controller
  double vertical_arm_m = 0.4;   ///< of the assumed vertical thrusters, fore and aft
} kTuning;

}  // namespace kelpie::format
