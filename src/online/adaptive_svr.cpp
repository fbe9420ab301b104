// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/adaptive_svr.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kelpie {

AdaptiveSvr::AdaptiveSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms)
 {
  const std::size_t count = settings.adapt == AdaptRule::challenger ? 2 : 1;
  learners_.reserve(count);
  while (learners_.size() < count) {
    learners_.emplace_back(inputs, settings, terms);
  }
}

std::size_t AdaptiveSvr::bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                               std::size_t terms) {
  return (settings.adapt == AdaptRule::challenger ? 2 : 1) *
             OnlineSvr::bytes(inputs, settings, terms) +
         sizeof(AdaptiveSvr);
}

void AdaptiveSvr::limit(const Budget& budget) {
  for (OnlineSvr& learner : learners_) {
    learner.limit(budget);
  }
}

Decision AdaptiveSvr::update(std::span<const double> z, double y, double t) noexcept {
  Decision decision = champion().update(z, y, t);
  tally_.add(decision);
  if (learners_.size() == 1 || decision.verdict == Verdict::invalid || !decision.had_model) {
    return decision;
  }
  const bool trying = detector_.trying();
  const Suspicion suspicion = watch(decision, z, y, t);
  if (suspicion == Suspicion::raised) {
    challenger().clear();
    ++tally_.suspicions;
  } else if (trying) {
    challenger().update(z, y, t);
  }
  if (suspicion == Suspicion::confirmed) {
    succeed(decision);
  }
  return decision;
}

double AdaptiveSvr::predict(std::span<const double> z) const noexcept {
  return champion().predict(z);
}

Status AdaptiveSvr::status() const {
  Status status = champion().status();
  status.tally = tally_;
  return status;
}

Suspicion AdaptiveSvr::watch(const Decision& decision, std::span<const double> z, double y,
                             double t) {
  std::optional<double> other;
  if (detector_.trying() && challenger().status().ready) {
    other = std::abs(y - challenger().predict(z));
  }
  // An error within half the tube is none: a model that fits exactly has no usual error.
  const double usual = std::max(champion().usual_error(), 0.5 * settings().epsilon);
  return detector_.judge(std::abs(y - decision.predicted), other, usual, t);
}

void AdaptiveSvr::succeed(Decision& decision) {
  const int before = champion().status().buffer;
  champion_ = 1 - champion_;
  const Status status = champion().status();
  decision.forgotten += before - status.buffer;
  tally_.forgotten += before - status.buffer;
  ++tally_.changes;
  decision.changed = true;
  decision.changed_since = detector_.since();
  decision.kkt_gap = status.kkt_gap;
  decision.served = true;
}

}  // namespace kelpie
