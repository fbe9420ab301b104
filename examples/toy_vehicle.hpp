// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "kelpie/core/random.hpp"

/// Stands for your vehicle: surge u [m/s] and yaw rate r [rad/s] under a port and a starboard
/// thruster n1, n2 [rev/s], with drag that nobody told the learner of.
struct ToyVehicle {
  static constexpr double kStepS = 0.1;

  double u = 0.0;
  double r = 0.0;
  double t = 0.0;  ///< s

  /// (u', r') at x = (u, r, n1, n2).
  static std::array<double, 2> accelerations(const std::array<double, 4>& x) {
    const double push = 0.010 * (x[2] * std::abs(x[2]) + x[3] * std::abs(x[3]));
    const double turn = 0.012 * (x[2] * std::abs(x[2]) - x[3] * std::abs(x[3]));
    return {push - 0.3 * x[0] - 0.7 * x[0] * std::abs(x[0]),
            turn - 0.4 * x[1] - 0.9 * x[1] * std::abs(x[1])};
  }

  /// Goes on for kStepS with these commands.
  void drive(double n1, double n2) {
    constexpr int kParts = 10;
    for (int part = 0; part < kParts; ++part) {
      const std::array<double, 2> a = accelerations({u, r, n1, n2});
      u += a[0] * kStepS / kParts;
      r += a[1] * kStepS / kParts;
    }
    t += kStepS;
  }
};

/// Commands of a pilot who tries everything slowly.
struct ToyPilot {
  double n1(double t) const { return 6.0 * std::sin(0.11 * t) + 3.0 * std::sin(0.37 * t); }
  double n2(double t) const { return 6.0 * std::sin(0.13 * t + 1.0) + 3.0 * std::sin(0.31 * t); }
};
