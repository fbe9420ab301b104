// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

namespace kelpie {

inline constexpr double kRadPerDegree = std::numbers::pi / 180.0;
inline constexpr double kFullTurn = 2.0 * std::numbers::pi;  ///< [rad]

/// The same angle within ±π [rad].
inline double wrapped(double angle) {
  return std::remainder(angle, kFullTurn);
}

}  // namespace kelpie
