// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kelpie::simulator {

/// Behavioural constants of the simulator; reference/simulator.md. Chosen by hand after the
/// instruments named here; no measurement is recorded.
inline constexpr struct Tuning {
  int least_sensor_rate_hz = 4;     ///< a DVL pings at about 4 Hz
  double half_window_s = 0.5;       ///< of the navigation filter that gives the accelerations
  double six_half_window_s = 0.15;  ///< … in the log of six axes: roll and pitch swing in 1 to 2 s
  double stick_lag_s = 0.5;         ///< a pilot's hand on a stick
  double pulse_per_share_us = 400.0;  ///< ArduSub's, and the range of Blue Robotics' Basic ESC
  double longest_delay_s = 10.0;      ///< of a command
  // Bounds of a scenario (docs/reference/limits.md); a tick costs about 2 µs, a row 300 bytes.
  double longest_drive_s = 30.0 * 86400.0;  ///< all phases together
  double most_rows = 2e6;                   ///< duration × rate
  double shortest_period_s = 0.1;           ///< of the excitation

  int progress_every_s = 100;  ///< simulated seconds between two reports; display alone
} kTuning;

}  // namespace kelpie::simulator
