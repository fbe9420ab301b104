// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "study/result.hpp"

namespace kelpie::study {

/// Nearest-rank quantile of the finite values: the smallest of them that is not exceeded by at
/// least the share `q` of all. It is always a value that occurred. NaN without finite values.
/// Requires 0 < q ≤ 1.
double nearest_rank(std::span<const double> values, double q);

/// Update times of one axis in µs, quantiles by nearest rank; NaN without updates.
struct UpdateTimes {
  double median = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};
UpdateTimes update_times(const AxisResult& axis);  ///< Of all updates of an axis.

/// R² of a validation point, NaN where no model was in service.
double served_r2(const ValidationPoint& point);

/// KKT gap of the model in service, NaN without one.
double served_gap(const Status& status);

/// Samples the including node turned away: explained, duplicate or invalid.
std::int64_t turned_away(const Tally& tally);

}  // namespace kelpie::study
