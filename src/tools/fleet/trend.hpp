// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "fleet/outcome.hpp"

namespace kelpie::fleet {

/// Trend of a vehicle's R² from mission to mission, in the missions' order.
struct Trend {
  std::vector<std::size_t> missions;  ///< indices of the missions with R²
  std::vector<double> r2;
  double early = kNoValue;  ///< median of the first third
  double late = kNoValue;   ///< median of the last third
  /// Probability of an equally strong trend by chance (Mann and Kendall's test, two-sided); NaN for
  /// fewer than kTuning.fewest_for_trend missions.
  double chance = kNoValue;
};

/// Computes early, late and chance. Cost: quadratic in the missions, 0.1 s for 10,000.
void judge(Trend& trend);

/// Whether a trend is significant among `tested` trends: chance below 0.05 with Bonferroni's
/// correction, and medians that differ by more than kTuning.clear_difference.
bool stands_out(const Trend& trend, std::size_t tested);

}  // namespace kelpie::fleet
