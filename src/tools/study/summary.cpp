// SPDX-License-Identifier: Apache-2.0
#include "study/summary.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/quantile.hpp"
#include "study/metrics.hpp"

namespace kelpie::study {
Quantiles quantiles_of(std::span<const double> values) {
  std::vector<double> finite;
  std::ranges::copy_if(values, std::back_inserter(finite),
                       [](double value) { return std::isfinite(value); });
  if (finite.empty()) {
    return {kUnknown, kUnknown, kUnknown, kUnknown};
  }
  return {quantile(finite, 0.5), quantile(finite, 0.99), quantile(finite, 0.999),
          quantile(finite, 1.0)};
}

double served_r2(const ValidationPoint& point) {
  return point.status.ready ? point.r2 : kUnknown;
}

std::optional<SinceChange> since_change(const StreamResult& result, const AxisResult& axis) {
  std::optional<double> since_s;
  const auto take = [&](double time_s) { since_s = std::max(since_s.value_or(time_s), time_s); };
  for (const Finding& finding : result.diagnosis.findings) {
    if (finding.state == FindingState::named) {
      take(finding.since_s);
    }
  }
  for (const ChangeFound& change : axis.changes) {
    if (change.withdrawn == 0) {
      take(change.since_s);
    }
  }
  if (!since_s || axis.stages.empty()) {
    return std::nullopt;
  }
  const StageEnd& last = axis.stages.back();
  const auto before = static_cast<std::size_t>(std::ranges::lower_bound(last.time_s, *since_s) -
                                               last.time_s.begin());
  if (before == 0) {
    return std::nullopt;
  }
  return SinceChange{
      *since_s, before, last.time_s.size() - before,
      r_squared(std::span(last.truth).subspan(before), std::span(last.predicted).subspan(before))};
}

double served_gap(const Status& status) {
  return status.ready ? status.kkt_gap : kUnknown;
}

bool turned_away(const TallyField& field) {
  return field.kind == TallyKind::arrival && field.total != &Tally::accepted &&
         field.total != &Tally::crowded_out;
}

std::int64_t turned_away(const Tally& tally) {
  std::int64_t sum = 0;
  for (const TallyField& field : tally_fields()) {
    sum += turned_away(field) ? tally.*field.total : 0;
  }
  return sum;
}

std::vector<TallyField> totals_by_kind() {
  std::vector<TallyField> totals(tally_fields().begin(), tally_fields().end());
  std::ranges::stable_sort(totals, {}, &TallyField::kind);
  return totals;
}

std::vector<TallyField> totals_of(TallyKind kind) {
  std::vector<TallyField> totals;
  std::ranges::copy_if(tally_fields(), std::back_inserter(totals),
                       [kind](const TallyField& field) { return field.kind == kind; });
  return totals;
}

}  // namespace kelpie::study
