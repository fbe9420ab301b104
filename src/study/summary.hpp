// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "study/result.hpp"

namespace kelpie::study {

/// Quantiles (core/quantile.hpp) of the finite ones of some values, of times in µs mostly; NaN
/// where there are none.
struct Quantiles {
  double median = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
};
Quantiles quantiles_of(std::span<const double> values);

/// R² of a validation point, NaN where no model was in service.
double served_r2(const ValidationPoint& point);

/// KKT gap of the model in service, NaN without one.
double served_gap(const Status& status);

/// Samples that were turned away when they came, whatever the budget: explained, duplicate,
/// invalid.
bool turned_away(const TallyField& field);
std::int64_t turned_away(const Tally& tally);

/// All totals in the order in which pages show them: by kind.
std::vector<TallyField> totals_by_kind();
std::vector<TallyField> totals_of(TallyKind kind);  ///< Those of one kind, in table order.

}  // namespace kelpie::study
