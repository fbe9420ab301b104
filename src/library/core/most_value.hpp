// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace kelpie {

/// The largest value of a valid sample: sums of products stay finite.
inline constexpr double kMostValue = 1e50;

/// Whether a sample may have this value.
inline bool is_usable(double value) {
  return std::abs(value) <= kMostValue;
}

}  // namespace kelpie
