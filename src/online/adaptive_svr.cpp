// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/adaptive_svr.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kelpie/core/quantile.hpp"

namespace kelpie {
namespace {

constexpr double kSamePlace = 0.99;  // κ_SE from which a sample lies where another does
constexpr std::size_t kMeasureEvery = 16;
constexpr std::size_t kLeast = 50;  // samples, before their misfits tell anything

// Makes the median of absolute errors a standard deviation, were they Gaussian.
constexpr double kGaussian = 1.4826;

}  // namespace

AdaptiveSvr::AdaptiveSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms)
    : sample_(inputs + terms) {
  const std::size_t count = settings.adapt == AdaptRule::challenger ? 2 : 1;
  learners_.reserve(count);
  while (learners_.size() < count) {
    learners_.emplace_back(inputs, settings, terms);
  }
}

std::size_t AdaptiveSvr::bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                               std::size_t terms) {
  const std::size_t one = OnlineSvr::bytes(inputs, settings, terms);
  const bool two = settings.adapt == AdaptRule::challenger;
  return sizeof(AdaptiveSvr) + (inputs + terms) * sizeof(double) + (two ? 2 * one : one);
}

void AdaptiveSvr::limit(const Budget& budget) {
  for (OnlineSvr& learner : learners_) {
    learner.limit(budget);
  }
}

Decision AdaptiveSvr::update(std::span<const double> z, double y, double t) noexcept {
  const bool adaptive = learners_.size() > 1;
  const bool trying = detector_.trying();
  const double error = adaptive ? lasting_error(champion(), z, y) : 0.0;
  const double other = trying ? lasting_error(challenger(), z, y) : 0.0;
  Decision decision = champion().update(z, y, t);
  tally_.add(decision);
  if (!adaptive || decision.verdict == Verdict::invalid || !decision.had_model) {
    return decision;
  }
  bool counts = false;
  if (trying) {
    const Decision step = challenger().update(z, y, t);
    counts = step.had_model && step.similarity < kSamePlace;
  }
  switch (detector_.judge(error, counts ? std::optional(other) : std::nullopt, usual_error(), t)) {
    case Suspicion::raised:
      challenger().clear();
      ++tally_.suspicions;
      break;
    case Suspicion::confirmed:
      succeed(decision);
      break;
    case Suspicion::none:
    case Suspicion::dismissed:
      break;
  }
  return decision;
}

void AdaptiveSvr::restate(const SampleMap& map) {
  for (OnlineSvr& learner : learners_) {
    learner.restate(map);
  }
  looks_ = 0;
}

double AdaptiveSvr::predict(std::span<const double> z) const noexcept {
  return champion().predict(z);
}

Status AdaptiveSvr::status() const {
  Status status = champion().status();
  status.tally = tally_;
  return status;
}

// What a learner is off by beyond the moment: what its fine part follows, a challenger's follows
// as well.
double AdaptiveSvr::lasting_error(const OnlineSvr& learner, std::span<const double> z, double y) {
  const bool known = learner.status().ready && z.size() == learner.model().kernel().dimension();
  return known ? std::abs(y - learner.model().lasting(z)) : 0.0;
}

// By how much the champion's lasting part misses the samples in its buffer, one after the other:
// more than it is off one step ahead, and a measure of what it doesn't know at all.
double AdaptiveSvr::usual_error() {
  const SampleCollector& buffer = champion().buffer();
  if (!champion().status().ready || buffer.size() < kLeast) {
    return std::numeric_limits<double>::infinity();
  }
  const std::size_t i = looks_ % buffer.size();
  buffer.samples().get(i, sample_);
  misfits_[looks_ % kMisfits] =
      std::abs(buffer.problem().targets()[i] - champion().model().lasting(sample_));
  if (++looks_ < kLeast) {
    return std::numeric_limits<double>::infinity();
  }
  if (looks_ % kMeasureEvery == 0 || looks_ == kLeast) {
    std::array<double, kMisfits> misfits = misfits_;
    const double median = quantile(std::span(misfits).first(std::min(looks_, kMisfits)), 0.5);
    // An error within half the tube is none.
    usual_error_ = std::max(kGaussian * median, 0.5 * settings().epsilon);
  }
  return usual_error_;
}

void AdaptiveSvr::succeed(Decision& decision) {
  const int before = champion().status().buffer;
  champion_ = 1 - champion_;
  looks_ = 0;
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
