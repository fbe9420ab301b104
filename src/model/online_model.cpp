// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/online_model.hpp"

#include <algorithm>
#include <cmath>

#include "kelpie/core/error.hpp"

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

void OnlineModel::update(std::span<const double> x, std::span<const double> y, double t,
                         const AxisDone& done) {
  const AccessGuard::Writer writing(access_);
  require_inputs(x);
  require_size("y", y.size(), axes());
  const double now = clock_.at(t);
  take_turns();
  for (std::size_t k = 0; k < axes(); ++k) {
    const std::size_t i = turns_[k];
    grant(i, axes() - 1 - k);
    decisions_[i] = learner(i).update(x, y[i], now);
    if (done) {
      done(i);
    }
  }
  share_changes();
  learned(x, y, now);
  for (Decision& decision : decisions_) {
    if (decision.changed || decision.returning) {
      decision.changed_since = clock_.stamp(decision.changed_since);
    }
  }
}

void OnlineModel::take_turns() {
  turns_.clear();
  for (const bool behind_now : {true, false}) {
    for (std::size_t i = 0; i < axes(); ++i) {
      if (behind(i) == behind_now) {
        turns_.push_back(i);
      }
    }
  }
}

void OnlineModel::learn_held_back() {
  const AccessGuard::Writer writing(access_);
  for (std::size_t i = 0; i < axes(); ++i) {
    learner(i).learn_held_back();
  }
}

void OnlineModel::share_changes() {
  for (const Decision& found : decisions_) {
    // Of a return the others hear when it is found, not when the past model is ready.
    const bool news = found.returning || (found.changed && found.recalled == 0);
    for (std::size_t i = 0; news && i < axes(); ++i) {
      if (!decisions_[i].changed && !decisions_[i].returning) {
        learner(i).alert(found.changed_since, !found.returning);
      }
    }
  }
}

}  // namespace kelpie
