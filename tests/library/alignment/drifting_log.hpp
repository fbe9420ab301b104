// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::testing {

/// A log at 5 Hz of a vehicle in the plane (u, v, r; commands n, m) in moving water, over ground,
/// with noise of 0.01 m/s² on accelerations, and the same drive through the water.
struct DriftingLog {
  using Water = std::function<std::array<double, 2>(double t)>;  ///< c₁, c₂ [m/s]

  static std::array<double, 2> still(double /*t*/) { return {}; }
  static std::array<double, 2> constant(double /*t*/) { return {0.25, -0.15}; }
  static std::array<double, 2> wandering(double t) {
    return {0.25 + 0.1 * std::sin(0.008 * t), -0.15 * std::cos(0.006 * t)};
  }

  explicit DriftingLog(const Water& water, std::size_t size = 4000, double turning = 1.0) {
    RandomStream random(5, "drive");
    double u = 0.5;
    double v = 0.0;
    double r = 0.0;
    double psi = 0.3;
    std::array<double, 2> command{};
    for (std::size_t i = 0; i < size; ++i) {
      if (i % 25 == 0) {
        command = {random.uniform(0.2, 1.0), turning * random.uniform(-1.0, 1.0)};
      }
      const double t = kStepS * static_cast<double>(i);
      const std::array<double, 3> a{
          0.5 * command[0] - 0.3 * u - 0.3 * u * std::abs(u) + 0.6 * v * r,
          -0.5 * v - 0.6 * v * std::abs(v) - 0.5 * u * r,
          0.4 * command[1] - 0.7 * r - 0.4 * r * std::abs(r) - 0.2 * u * v};
      const auto [c1, c2] = water(t);
      const double ahead = c1 * std::cos(psi) + c2 * std::sin(psi);
      const double aside = c2 * std::cos(psi) - c1 * std::sin(psi);
      through_water.insert(through_water.end(), {u, v, r, command[0], command[1]});
      inputs.insert(inputs.end(), {u + ahead, v + aside, r, command[0], command[1]});
      targets.insert(targets.end(),
                     {a[0] + r * aside + 0.01 * random.normal(),
                      a[1] - r * ahead + 0.01 * random.normal(), a[2] + 0.01 * random.normal()});
      headings.push_back(psi);
      rows.push_back(i);
      times.push_back(t);
      for (int part = 0; part < 4; ++part) {
        u += 0.25 * kStepS * a[0];
        v += 0.25 * kStepS * a[1];
        psi += 0.25 * kStepS * r;
        r += 0.25 * kStepS * a[2];
      }
    }
  }

  AlignmentProblem problem() const {
    return {.inputs = inputs,
            .targets = targets,
            .times_s = times,
            .configurations = {},
            .rows = rows,
            .input_names = {"u", "v", "r", "n", "m"},
            .target_count = 3,
            .states = "auto",
            .rate_hz = 1.0 / kStepS};
  }

  static constexpr double kStepS = 0.2;
  std::vector<double> through_water;  ///< inputs without the current
  std::vector<double> inputs, targets, headings, times;
  std::vector<std::size_t> rows;
};

}  // namespace kelpie::testing
