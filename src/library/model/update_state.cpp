// SPDX-License-Identifier: Apache-2.0
#include "model/update_state.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie {

double ModelClock::at(double t) {
  if (std::isfinite(t)) {
    offset_ = std::max(offset_, last_ - t);
    last_ = t + offset_;
  }
  return t + offset_;
}

void ModelClock::visit(Archive& archive) {
  archive.number(offset_);
  archive.any_number(last_);
}

bool UpdateState::crowded_out() const {
  return std::ranges::any_of(
      decisions, [](const Decision& decision) { return decision.verdict == Verdict::crowded_out; });
}

void UpdateState::stamp_changes() {
  for (Decision& decision : decisions) {
    if (decision.changed || decision.returning) {
      decision.changed_since = clock.stamp(decision.changed_since);
    }
  }
}

}  // namespace kelpie
