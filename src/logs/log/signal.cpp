// SPDX-License-Identifier: Apache-2.0
#include "log/signal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/quantile.hpp"

namespace kelpie::log {

void sort_by_time(Signal& signal) {
  for (std::size_t k = 1; k < signal.times_s.size(); ++k) {
    const double back = signal.times_s[k - 1] - signal.times_s[k];
    signal.steps_back += back > 0.0 ? 1 : 0;
    signal.longest_back_s = std::max(signal.longest_back_s, back);
  }
  if (signal.steps_back == 0) {
    return;
  }
  std::vector<std::size_t> order(signal.times_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return signal.times_s[k]; });
  const Signal as_stored = signal;
  for (std::size_t k = 0; k < order.size(); ++k) {
    signal.times_s[k] = as_stored.times_s[order[k]];
    signal.values[k] = as_stored.values[order[k]];
  }
}

double median_step_s(const Signal& signal) {
  std::vector<double> steps;
  double before = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < signal.times_s.size(); ++k) {
    if (std::isfinite(signal.values[k]) && signal.times_s[k] != before) {
      steps.push_back(signal.times_s[k] - before);
      before = signal.times_s[k];
    }
  }
  if (steps.size() < 2) {
    return 0.0;
  }
  steps.erase(steps.begin());  // there was none before the first
  return quantile(steps, 0.5);
}

}  // namespace kelpie::log
