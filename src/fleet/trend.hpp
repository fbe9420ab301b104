// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "fleet/outcome.hpp"

namespace kelpie::fleet {

/// Whether a vehicle's R² changes from mission to mission, in their order.
struct Trend {
  std::vector<std::size_t> missions;  ///< places of those that have one
  std::vector<double> r2;
  double early = kNoValue;  ///< median of the first third
  double late = kNoValue;   ///< median of the last third
  /// Chance of so strong a trend where there is none (Mann and Kendall's test, two-sided); NaN with
  /// fewer than kFewestForTrend missions.
  double chance = kNoValue;
};
inline constexpr std::size_t kFewestForTrend = 10;

/// Fills in early, late and chance. Cost: quadratic in the missions, 0.1 s for 10,000.
void judge(Trend& trend);

/// Whether a trend stands out among `tested` others: chance below 0.05 with Bonferroni's
/// correction, and a change of the medians beyond kClearly.
bool stands_out(const Trend& trend, std::size_t tested);

}  // namespace kelpie::fleet
