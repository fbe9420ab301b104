// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kelpie::log {

/// Behavioural constants of the room. "By hand" means: chosen by hand, no measurement recorded.
inline constexpr struct Tuning {
  // Tables (docs/limits.md).
  std::size_t longest_line = std::size_t{1} << 20U;  ///< bytes; by hand
  std::size_t most_columns = 10'000;                 ///< by hand
  std::size_t most_words = 4'000'000;                ///< 40 bytes each in memory; by hand

  // Sampling.
  double longest_silence_s = 30.0 * 86400.0;  ///< within a log; then a clock was set; by hand
  std::size_t most_rows_per_sample = 1000;    ///< a higher rate is a mistake; by hand
  std::size_t most_rows = 10'000'000;         ///< of samples: 11 days at 10 Hz; by hand
  double joined_gap_s = 60.0;                 ///< between joined logs; by hand

  // Drafts (docs/templates.md).
  double usual_rate_hz = 10.0;     ///< of rows; by hand
  double fastest_rate_hz = 50.0;   ///< of rows of a short log; by hand
  double wanted_rows = 1000.0;     ///< of a short log; by hand
  double few_rows = 300.0;         ///< below: a remark; by hand
  double longest_gap_s = 5.0;      ///< for commands sent on change; by hand
  double slow_hz = 5.0;            ///< thrusters answer within tenths of a second; by hand
  double farthest_stamps_s = 1.0;  ///< between the median offsets of two clocks; by hand
  double widest_stamps_s = 10.0;   ///< range of a clock's offset; by hand
  double least_motion = 0.1;       ///< heave's range, of the largest velocity's range; by hand
  int rank_by_name = 5;            ///< of velocities known only by name; by hand
  int rank_other_system = 5;       ///< added for MAVLink messages of other senders; by hand
} kTuning{};

}  // namespace kelpie::log
