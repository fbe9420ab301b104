// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::stream {

/// Constants of SampleStream, chosen by hand; no measurement recorded. Settings:
/// docs/howto/logs.md.
inline constexpr struct Tuning {
  /// Messages per source in a row with old stamps, after which a clock was set.
  std::size_t messages_behind = 8;
  /// Equal samples of a stuck signal: two equal values on both sides of a gap are no evidence.
  std::size_t stuck_samples = 5;
  /// Missing samples at the newer edge of a causal window, as a multiple of the mean step.
  double causal_steps = 2.0;
  /// [s] A sample this close to an edge of a window is inside; stamps have nanoseconds.
  double window_rounding_s = 1e-9;

  /// Least increments of a pose's source in a window: the weights change sign five times.
  std::size_t pose_increments = 6;

  // Ranges of settings (docs/reference/limits.md).
  double fastest_hz = 1e6;         ///< rows per second
  double longest_gap_s = 1e6;      ///< 12 days
  double longest_wait_s = 1e6;     ///< 12 days
  double longest_window_s = 60.0;  ///< a row costs the work of all samples in the window
  double longest_lag_s = 1e4;      ///< of a signal, either way
} kTuning;

}  // namespace kelpie::stream
