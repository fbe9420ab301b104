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

double robust_deviation(std::span<double> magnitudes) {
  return kSigmaPerMedian * quantile(magnitudes, 0.5);
}

}  // namespace kelpie
