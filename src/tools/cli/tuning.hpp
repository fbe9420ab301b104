// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kelpie::cli {

/// What the command takes for granted about logs and vehicles. Chosen by hand; no measurement
/// recorded.
inline constexpr struct Tuning {
  double unix_time_s = 1e8;   ///< a time stamp later than this counts from 1970
  double far_margin = 0.5;    ///< of the range learned: inputs beyond are another vehicle's
  double lightest_kg = 1e-6;  ///< vehicle that an option takes
  double heaviest_kg = 1e9;
} kTuning;

}  // namespace kelpie::cli
