// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace kelpie {

constexpr std::int64_t kSecondNs = 1'000'000'000;
inline constexpr double kSecondsPerHour = 3600.0;

/// The gap rule: the longest step within a stretch of samples, in usual steps. A longer step is a
/// gap; nothing is fitted, shifted or predicted across a gap. By hand; no measurement recorded.
inline constexpr double kLongestStep = 3.0;

/// Nanoseconds in s. Up to 104 days (2^53 ns) the nearest double; beyond, whole seconds are exact
/// and the resolution is that of a double: 0.12 µs for times since 1970. So count from a start.
inline double seconds(std::int64_t nanoseconds) {
  constexpr std::int64_t kExact = std::int64_t{1} << 53;
  if (-kExact <= nanoseconds && nanoseconds <= kExact) {
    return static_cast<double>(nanoseconds) / static_cast<double>(kSecondNs);
  }
  const std::int64_t whole = nanoseconds / kSecondNs;
  return static_cast<double>(whole) +
         static_cast<double>(nanoseconds % kSecondNs) / static_cast<double>(kSecondNs);
}

/// Seconds in ns. Requires less than 292 years.
inline std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * static_cast<double>(kSecondNs)));
}

}  // namespace kelpie
