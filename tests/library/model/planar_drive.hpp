// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::testing {

/// A vehicle with surge, yaw and two thrusters whose equations are linear in Fossen's terms, driven
/// by slow commands and integrated in small steps.
struct PlanarDrive {
  std::vector<std::string> inputs{"u", "r", "n1", "n2"};
  std::vector<std::string> targets{"udot", "rdot"};
  std::vector<std::array<double, 4>> x;
  std::vector<std::array<double, 2>> y;
  std::vector<double> t;

  /// Accelerations; `strength` scales the first thruster, `other` the second.
  static std::array<double, 2> accelerations(std::span<const double> x, double strength = 1.0,
                                             double other = 1.0) {
    const double n1 = strength * x[2] * std::abs(x[2]);
    const double n2 = other * x[3] * std::abs(x[3]);
    return {-0.2 * x[0] - 0.6 * x[0] * std::abs(x[0]) + 0.01 * (n1 + n2) + 0.1 * x[1] * x[1],
            -0.3 * x[1] - 0.5 * x[1] * std::abs(x[1]) + 0.02 * (n1 - n2)};
  }

  void drive(std::uint64_t seed, std::size_t samples, double step_s, double strength = 1.0,
             double other = 1.0) {
    constexpr int kFine = 50;
    RandomStream random(seed, "planar");
    const std::array<double, 4> rate{random.uniform(0.05, 0.2), random.uniform(0.05, 0.2),
                                     random.uniform(0.2, 0.4), random.uniform(0.2, 0.4)};
    std::array<double, 4> now = x.empty() ? std::array<double, 4>{} : x.back();
    double time = t.empty() ? 0.0 : t.back();
    for (std::size_t i = 0; i < samples; ++i) {
      for (int fine = 0; fine < kFine; ++fine) {
        time += step_s / kFine;
        now[2] = 5.0 * std::sin(rate[0] * time) + 3.0 * std::sin(rate[2] * time);
        now[3] = 5.0 * std::cos(rate[1] * time) + 3.0 * std::sin(rate[3] * time);
        const std::array<double, 2> a = accelerations(now, strength, other);
        now[0] += a[0] * step_s / kFine;
        now[1] += a[1] * step_s / kFine;
      }
      x.push_back(now);
      y.push_back(accelerations(now, strength, other));
      t.push_back(time);
    }
  }
};

}  // namespace kelpie::testing
