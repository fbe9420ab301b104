// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "kelpie/core/random.hpp"
#include "svr/kernel_matrix.hpp"

namespace kelpie::lab {

/// An endless made-up stream of six wandering inputs and a drifting function, with noise, outliers,
/// exact duplicates with equal and with contradicting targets, and stretches at rest.
class SoakStream {
 public:
  static constexpr std::size_t kInputs = 6;

  /// Standardised inputs and target.
  struct Sample {
    std::array<double, kInputs> z{};
    double y = 0.0;
  };

  explicit SoakStream(std::uint64_t seed);  ///< The same for the same seed.

  Sample next();

 private:
  double function(const std::array<double, kInputs>& z) const;

  RandomStream random_;
  std::array<double, kInputs> phase_{};
  double drift_ = 0.0;
  int resting_ = 0;
  Sample last_;
};

/// Length of the test, and interval of the checks.
struct SoakPlan {
  std::size_t updates = 1'000'000;
  std::size_t window = 300;
  std::size_t check_every = 1000;
  std::uint64_t seed = 1;
  /// Called now and then with the finished updates; false stops the work.
  std::function<bool(std::size_t)> keep_going = [](std::size_t) { return true; };
};

/// The results of a run.
struct SoakRun {
  std::size_t updates = 0;  ///< fewer than planned when stopped
  std::size_t fallbacks = 0;
  double gap = 0.0;        ///< largest KKT gap on residuals computed afresh
  double median_us = 0.0;  ///< of an update
  double max_us = 0.0;

  static constexpr double kGapAllowed = 1e-6;

  /// Whether the gap is allowed and at most an update in 100,000 (1 in a short run) needed SMO.
  bool good() const {
    constexpr std::size_t kPerFallback = 100'000;
    return gap <= kGapAllowed && fallbacks <= (updates + kPerFallback - 1) / kPerFallback;
  }
};

/// A sliding window over a SoakStream. The same plan gives the same gaps and fallbacks.
SoakRun run_soak(const SoakPlan& plan);

/// A line for a terminal: gap, allowed gap, times, and the verdict.
std::string soak_text(const SoakRun& run);

}  // namespace kelpie::lab
