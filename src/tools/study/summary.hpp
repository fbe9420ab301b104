// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "study/result.hpp"

namespace kelpie::study {

/// Quantiles (core/quantile.hpp) of the finite values, mostly times in µs; NaN without values.
struct Quantiles {
  double median = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
  double max = 0.0;
};
Quantiles quantiles_of(std::span<const double> values);

/// R² of a validation point, NaN without a model in service.
double served_r2(const ValidationPoint& point);

/// The held-out rows of AxisResult::r2_final on both sides of the last change of the vehicle.
struct SinceChange {
  double since_s = 0.0;
  std::size_t before = 0;  ///< rows before, which judge a model of the changed vehicle wrongly
  std::size_t rows = 0;    ///< rows since then
  double r2 = kUnknown;    ///< on the rows since then, at the end
};

/// The last change that stands: a named cause, or a model of this axis that was not taken back.
/// Empty without one, and without held-out rows before.
std::optional<SinceChange> since_change(const StreamResult& result, const AxisResult& axis);

/// KKT gap of the model in service, NaN without one.
double served_gap(const Status& status);

/// Samples rejected on arrival for a reason other than the budget: explained, duplicate, invalid.
bool turned_away(const TallyField& field);
std::int64_t turned_away(const Tally& tally);

/// All totals in the order of pages: by kind.
std::vector<TallyField> totals_by_kind();
std::vector<TallyField> totals_of(TallyKind kind);  ///< Totals of one kind, in table order.

}  // namespace kelpie::study
