// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kelpie/core/random.hpp"
#include "lab/offline_svr.hpp"

namespace kelpie::testing {

/// A log of two inputs of very different size and one target, in time order.
struct Log {
  Log(std::uint64_t seed, std::size_t samples) {
    RandomStream random(seed, "log");
    double phase = random.uniform(0.0, 6.0);
    for (std::size_t i = 0; i < samples; ++i) {
      phase += random.uniform(0.02, 0.3);
      const double a = 2.0 * std::sin(phase);
      const double b = random.uniform(30.0, 70.0) + 2.0 * a;
      x.insert(x.end(), {a, b});
      y.push_back(3.0 + std::sin(a) + 0.01 * (b - 50.0) + 0.05 * random.normal());
      rows.push_back(i);
    }
  }

  /// Every row that isn't listed becomes NaN.
  void poison_all_but(const std::vector<std::size_t>& kept) {
    for (std::size_t i = 0; i < y.size(); ++i) {
      if (!std::ranges::binary_search(kept, i)) {
        x[2 * i] = x[2 * i + 1] = y[i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  lab::TrainingRows view() const {
    return {.x = x, .inputs = 2, .y = y, .targets = 1, .target = 0, .rows = rows};
  }

  std::vector<double> x;
  std::vector<double> y;
  std::vector<std::size_t> rows;
};

}  // namespace kelpie::testing
