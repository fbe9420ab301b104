// SPDX-License-Identifier: Apache-2.0
#include "study/metrics.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace kelpie::study {

double r_squared(std::span<const double> truth, std::span<const double> predicted) {
  const double mean =
      std::accumulate(truth.begin(), truth.end(), 0.0) / static_cast<double>(truth.size());
  double residual = 0.0;
  double total = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    residual += (predicted[i] - truth[i]) * (predicted[i] - truth[i]);
    total += (mean - truth[i]) * (mean - truth[i]);
  }
  return total > 0.0 ? 1.0 - residual / total : std::numeric_limits<double>::quiet_NaN();
}

double power_exponent(std::span<const double> x, std::span<const double> y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / n;
    mean_y += std::log(y[i]) / n;
  }
  double square = 0.0;
  double product = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    square += dx * dx;
    product += dx * (std::log(y[i]) - mean_y);
  }
  return square > 0.0 ? product / square : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace kelpie::study
