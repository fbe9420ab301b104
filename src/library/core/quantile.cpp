// SPDX-License-Identifier: Apache-2.0
#include "core/quantile.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {

double quantile(std::span<double> values, double p) {
  const double position = p * static_cast<double>(values.size() - 1);
  const double floor = std::floor(position);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(floor);
  // Sorting needs an order, and NaN has none.
  const auto less = [](double a, double b) { return a < b || (std::isnan(b) && !std::isnan(a)); };
  std::nth_element(values.begin(), middle, values.end(), less);
  if (position == floor) {
    return *middle;
  }
  const double above = *std::min_element(middle + 1, values.end());
  return *middle + (position - floor) * (above - *middle);
}

double conformal_bound(std::span<double> values, double coverage) {
  const auto n = static_cast<double>(values.size());
  const double rank = std::min(std::ceil(coverage * (n + 1.0)), n);
  const auto bound = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::ranges::nth_element(values, bound);
  return *bound;
}

double robust_deviation(std::span<double> magnitudes) {
  return kSigmaPerMedian * quantile(magnitudes, 0.5);
}

}  // namespace kelpie
