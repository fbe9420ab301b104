// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/adaptive_svr.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kelpie/core/quantile.hpp"

namespace kelpie {
namespace {

constexpr double kSamePlace = 0.99;  // κ_SE from which a sample lies where another does
constexpr std::size_t kMeasureEvery = 16;
constexpr std::size_t kLeast = 50;  // samples in the buffer before its misfits tell anything

// Makes the median of absolute errors a standard deviation, were they Gaussian.
constexpr double kGaussian = 1.4826;

}  // namespace

AdaptiveSvr::AdaptiveSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms)
    : misfits_(settings.adapt == AdaptRule::challenger ? settings.places() : 0) {
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
  return sizeof(AdaptiveSvr) + (two ? 2 * one + settings.places() * sizeof(double) : one);
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

// By how much the champion's lasting part misses the samples in its buffer, those it can't explain
// among them: more than it is off one step ahead, and a measure of what it doesn't know at all.
double AdaptiveSvr::usual_error() {
  if (since_measured_++ % kMeasureEvery == 0) {
    const DualProblem& problem = champion().buffer().problem();
    const std::size_t n = problem.size();
    const std::span<double> misfits = std::span(misfits_).first(n);
    const double bias = problem.kkt().bias();
    for (std::size_t i = 0; i < n; ++i) {
      // A sample's own share of the fine part; its neighbours' are small beside it.
      const double fine = settings().fine * problem.beta()[i];
      misfits[i] = std::abs(problem.gradient()[i] - bias + fine);
    }
    // An error within half the tube is none.
    usual_error_ = n < kLeast
                       ? std::numeric_limits<double>::infinity()
                       : std::max(kGaussian * quantile(misfits, 0.5), 0.5 * problem.epsilon());
  }
  return usual_error_;
}

void AdaptiveSvr::succeed(Decision& decision) {
  const int before = champion().status().buffer;
  champion_ = 1 - champion_;
  since_measured_ = 0;
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
