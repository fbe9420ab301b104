// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::stream {

/// Constants of SampleStream, chosen by hand; no measurement recorded. Settings:
/// docs/from_topics.md.
inline constexpr struct Tuning {
  /// Messages per source in a row with old stamps, after which a clock was set.
  std::size_t messages_behind = 8;
  /// Equal samples of a stuck signal: two equal values on both sides of a gap are no evidence.
  std::size_t stuck_samples = 5;
  /// Missing samples at the newer edge of a causal window, as a multiple of the mean step.
  double causal_steps = 2.0;
  /// [s] A sample this close to an edge of a window is inside; stamps have nanoseconds.
  double window_rounding_s = 1e-9;
} kTuning;

}  // namespace kelpie::stream
