// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/model/alignment.hpp"

namespace kelpie::testing {

/// A log of a vehicle with two velocities and two thrusters at 10 Hz. Commands are logged `late`
/// rows after they act (below 0: before).
struct LateLog {
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
      inputs.insert(inputs.end(), {u, v, at(first, -late), at(second, -late)});
      targets.insert(targets.end(), {udot + 0.02 * random.normal(), vdot + 0.02 * random.normal()});
      times.push_back(0.1 * static_cast<double>(i));
      u += 0.1 * udot;
      v += 0.1 * vdot;
    }
    rows.resize(size);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
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

}  // namespace kelpie::testing
