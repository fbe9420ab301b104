// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kelpie::vehicle {

/// Behavioural constants of the simulator; docs/vehicle.md describes them. Chosen by hand after the
/// instruments named here; no measurement is recorded.
inline constexpr struct Tuning {
  int least_sensor_rate_hz = 4;  ///< a DVL pings at about 4 Hz
  double half_window_s = 0.5;    ///< of the navigation filter that gives the accelerations
  // Bounds of a scenario (docs/limits.md); a tick costs about 2 µs, a row 300 bytes.
  double longest_drive_s = 30.0 * 86400.0;  ///< all phases together
  double most_rows = 2e6;                   ///< duration × rate
  double shortest_period_s = 0.1;           ///< of the excitation

  int progress_every_s = 100;  ///< simulated seconds between two reports; display alone
} kTuning;

}  // namespace kelpie::vehicle
