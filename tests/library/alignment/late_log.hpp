// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::testing {

/// A log of a vehicle with two velocities and two thrusters at 10 Hz.
struct TwoAxisLog {
  void add(const std::array<double, 4>& x, const std::array<double, 2>& y) {
    inputs.insert(inputs.end(), x.begin(), x.end());
    targets.insert(targets.end(), y.begin(), y.end());
    rows.push_back(times.size());
    times.push_back(0.1 * static_cast<double>(times.size()));
  }

  AlignmentProblem problem(const std::vector<std::string>& names = {"u", "v", "n", "m"}) const {
    return {.inputs = inputs,
            .targets = targets,
            .times_s = times,
            .configurations = {},
            .rows = rows,
            .input_names = names,
            .target_count = 2,
            .states = "auto",
            .rate_hz = 10.0};
  }

  std::vector<double> inputs;
  std::vector<double> targets;
  std::vector<double> times;
  std::vector<std::size_t> rows;
};

/// A log with commands `late` rows after the effect of the commands (below 0: before).
struct LateLog : TwoAxisLog {
  explicit LateLog(int late, std::size_t size = 2000) {
    RandomStream random(7, "drive");
    std::vector<double> first;
    std::vector<double> second;
    double phase = 0.0;
    double slow = 0.0;
    for (std::size_t i = 0; i < size + 100; ++i) {
      phase += random.uniform(0.02, 0.2);
      slow += random.uniform(0.02, 0.15);
      first.push_back(10.0 * std::sin(phase));
      second.push_back(10.0 * std::cos(slow));
    }
    double u = 0.0;
    double v = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      const auto at = [&](const std::vector<double>& n, int shift) {
        return n[i + 50 + static_cast<std::size_t>(shift)];
      };
      const double n = at(first, 0);
      const double m = at(second, 0);
      const double udot = 0.01 * n * std::abs(n) - 2.0 * u * std::abs(u) - 0.3 * u;
      const double vdot = 0.01 * m * std::abs(m) - 3.0 * v * std::abs(v) - 0.5 * u * v;
      add({u, v, at(first, -late), at(second, -late)},
          {udot + 0.02 * random.normal(), vdot + 0.02 * random.normal()});
      u += 0.1 * udot;
      v += 0.1 * vdot;
    }
  }
};

}  // namespace kelpie::testing
