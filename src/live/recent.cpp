// SPDX-License-Identifier: Apache-2.0
#include "live/recent.hpp"

#include <algorithm>
#include <limits>

namespace kelpie::live {

double r_squared(const std::vector<Said>& samples) {
  double mean = 0.0;
  for (const Said& said : samples) {
    mean += said.truth / static_cast<double>(samples.size());
  }
  double residual = 0.0;
  double total = 0.0;
  for (const Said& said : samples) {
    residual += (said.predicted - said.truth) * (said.predicted - said.truth);
    total += (said.truth - mean) * (said.truth - mean);
  }
  return total > 0.0 ? 1.0 - residual / total : std::numeric_limits<double>::quiet_NaN();
}

double coverage(const std::vector<Said>& samples) {
  const auto inside = static_cast<double>(std::ranges::count(samples, true, &Said::is_inside));
  return samples.empty() ? std::numeric_limits<double>::quiet_NaN()
                         : inside / static_cast<double>(samples.size());
}

}  // namespace kelpie::live
