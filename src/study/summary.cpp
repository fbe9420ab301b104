// SPDX-License-Identifier: Apache-2.0
#include "study/summary.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace kelpie::study {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> sorted_finite(std::span<const double> values) {
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](double value) { return std::isfinite(value); });
  std::sort(finite.begin(), finite.end());
  return finite;
}

double at_rank(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) {
    return kNan;
  }
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace

double nearest_rank(std::span<const double> values, double q) {
  return at_rank(sorted_finite(values), q);
}

UpdateTimes update_times(const AxisResult& axis) {
  const std::vector<double> sorted = sorted_finite(axis.update_us);
  return {at_rank(sorted, 0.5), at_rank(sorted, 0.99), at_rank(sorted, 1.0)};
}

double served_r2(const ValidationPoint& point) {
  return point.status.ready ? point.r2 : kNan;
}

double served_gap(const Status& status) {
  return status.ready ? status.kkt_gap : kNan;
}

std::int64_t turned_away(const Tally& tally) {
  return tally.explained + tally.duplicate + tally.invalid;
}

}  // namespace kelpie::study
