// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "kelpie/core/random.hpp"

/// Stands for your vehicle: surge u [m/s] and yaw rate r [rad/s] under a port and a starboard
/// thruster n1, n2 [rev/s], with drag that is unknown to the learner.
class ToyVehicle {
 public:
  static constexpr double kStepS = 0.1;

  double t() const { return t_; }  ///< s
  double u() const { return u_; }
  double r() const { return r_; }

  /// A sample's inputs (u, r, n1, n2) with these commands.
  std::array<double, 4> inputs(double n1, double n2) const { return {u_, r_, n1, n2}; }

  /// The measured accelerations (u', r') there, with noise.
  std::array<double, 2> measure(const std::array<double, 4>& x) {
    const auto [udot, rdot] = accelerations(x);
    return {udot + 0.01 * random_.normal(), rdot + 0.01 * random_.normal()};
  }

  /// Drives for kStepS with these commands.
  void drive(double n1, double n2) {
    constexpr int kParts = 10;
    for (int part = 0; part < kParts; ++part) {
      const auto [udot, rdot] = accelerations(inputs(n1, n2));
      u_ += udot * kStepS / kParts;
      r_ += rdot * kStepS / kParts;
    }
    t_ += kStepS;
  }

  /// The command by which a thruster gives a share of the thrust of n: a damaged thruster's.
  static double weakened(double n, double share) { return n * std::sqrt(share); }

  /// Commands (n1, n2) at a time of a pilot who slowly tries all combinations.
  static std::array<double, 2> pilot(double t) {
    return {6.0 * std::sin(0.11 * t) + 3.0 * std::sin(0.37 * t),
            6.0 * std::sin(0.13 * t + 1.0) + 3.0 * std::sin(0.31 * t)};
  }

 private:
  static std::array<double, 2> accelerations(const std::array<double, 4>& x) {
    const auto [u, r, n1, n2] = x;
    const double port = 0.01 * n1 * std::abs(n1);
    const double starboard = 0.01 * n2 * std::abs(n2);
    return {port + starboard - 0.3 * u - 0.7 * u * std::abs(u),
            port - starboard - 0.4 * r - 0.9 * r * std::abs(r)};
  }

  double u_ = 0.0;
  double r_ = 0.0;
  double t_ = 0.0;
  kelpie::RandomStream random_{1, "toy vehicle"};
};
