// SPDX-License-Identifier: Apache-2.0
#include "vehicle/standstill.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "vehicle/tuning.hpp"

namespace kelpie {
Standstill::Standstill(std::vector<std::size_t> watched)
    : watched_(std::move(watched)),
      last_(watched_.size(), std::numeric_limits<double>::quiet_NaN()),
      since_(watched_.size()),
      run_(watched_.size()),
      held_(watched_.size()),
      longest_(watched_.size()),
      frozen_(watched_.size()),
      stopped_(watched_.size()) {}

void Standstill::update(std::span<const double> x, double t) {
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const double value = x[watched_[i]];
    if (value == last_[i]) {
      ++run_[i];
      ++held_[i];
      continue;
    }
    begin_hold(i, t);
    frozen_[i] = 0;
    run_[i] = 0;
    last_[i] = value;
  }
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const bool moving = others_move(i);
    if (!moving && frozen_[i] == 0) {  // a rest of the vehicle tells nothing of a sensor
      begin_hold(i, t);
    }
    const bool long_enough =
        held_[i] >= std::max(kDiagnosis.frozen_rows, kDiagnosis.frozen_factor * longest_[i]) &&
        t - since_[i] >= kDiagnosis.frozen_s && moving;
    stopped_[i] = frozen_[i] == 0 && long_enough ? 1 : 0;
    frozen_[i] = frozen_[i] != 0 || long_enough ? 1 : 0;
  }
}

bool Standstill::any() const {
  return std::ranges::any_of(frozen_, [](char frozen) { return frozen != 0; });
}

// A vehicle at rest, or a log that has stopped, stands still altogether.
bool Standstill::others_move(std::size_t i) const {
  for (std::size_t other = 0; other < watched_.size(); ++other) {
    if (other != i && run_[other] < kDiagnosis.frozen_rows / 4) {
      return true;
    }
  }
  return false;
}

void Standstill::begin_hold(std::size_t i, double t) {
  if (frozen_[i] == 0) {
    longest_[i] = std::max(longest_[i], held_[i]);
  }
  held_[i] = 0;
  since_[i] = t;
}

void Standstill::visit(Archive& archive) {
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    archive.any_number(last_[i]);
    archive.number(since_[i]);
    archive.whole(run_[i]);
    archive.whole(held_[i]);
    archive.whole(longest_[i]);
    archive.whole(frozen_[i], 0, 1);
  }
}

}  // namespace kelpie
