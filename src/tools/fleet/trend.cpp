// SPDX-License-Identifier: Apache-2.0
#include "fleet/trend.hpp"

#include <algorithm>
#include <cmath>

#include "core/quantile.hpp"
#include "fleet/tuning.hpp"

namespace kelpie::fleet {
namespace {

double median(std::vector<double> values) {
  return quantile(values, 0.5);
}

// S of Mann and Kendall is normal enough from ten values on.
double chance_of_trend(const std::vector<double>& values) {
  double s = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = i + 1; j < values.size(); ++j) {
      s += values[j] > values[i] ? 1.0 : values[j] < values[i] ? -1.0 : 0.0;
    }
  }
  const auto n = static_cast<double>(values.size());
  const double deviation = std::sqrt(n * (n - 1.0) * (2.0 * n + 5.0) / 18.0);
  return std::erfc(std::max(0.0, std::abs(s) - 1.0) / deviation / std::sqrt(2.0));
}

}  // namespace

void judge(Trend& trend) {
  if (trend.r2.size() < kTuning.fewest_for_trend) {
    return;
  }
  const auto third = static_cast<std::ptrdiff_t>(trend.r2.size() / 3);
  trend.early = median({trend.r2.begin(), trend.r2.begin() + third});
  trend.late = median({trend.r2.end() - third, trend.r2.end()});
  trend.chance = chance_of_trend(trend.r2);
}

bool stands_out(const Trend& trend, std::size_t tested) {
  return trend.chance * static_cast<double>(tested) < kTuning.trend_level &&
         std::abs(trend.late - trend.early) > kTuning.clear_difference;
}

}  // namespace kelpie::fleet
