// SPDX-License-Identifier: Apache-2.0
#include "study/metrics.hpp"

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

}  // namespace kelpie::study
