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

std::vector<OnlineSvr> make_learners(std::size_t inputs, const OnlineSvrSettings& settings,
                                     std::size_t terms) {
  const std::size_t count = settings.adapt == AdaptRule::challenger ? 2 : 1;
  std::vector<OnlineSvr> learners;
  learners.reserve(count);
  while (learners.size() < count) {
    learners.emplace_back(inputs, settings, terms);
  }
  return learners;
}

}  // namespace

AdaptiveSvr::AdaptiveSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms)
    : learners_(make_learners(inputs, settings, terms)),
      memory_(learners_.front().buffer(), settings),
      sample_(inputs + terms) {}

std::size_t AdaptiveSvr::bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                               std::size_t terms) {
  const std::size_t one = OnlineSvr::bytes(inputs, settings, terms);
  const bool two = settings.adapt == AdaptRule::challenger;
  return sizeof(AdaptiveSvr) + (inputs + terms) * sizeof(double) + (two ? 2 * one : one) +
         ModelMemory::bytes(inputs + terms, settings);
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
  std::optional<double> compared;
  if (trying) {
    const Decision step = challenger().update(z, y, t);
    if (step.had_model && step.similarity < kSamePlace) {
      compared = other;
    }
  }
  memory_.observe(z, y, error, t);
  judge(decision, error, compared, t);
  if (!decision.changed) {
    remember(decision, t);
  }
  return decision;
}

void AdaptiveSvr::judge(Decision& decision, double error, std::optional<double> other, double t) {
  switch (detector_.judge(error, other, usual_error(), t)) {
    case Suspicion::raised:
      challenger().clear();
      ++tally_.suspicions;
      break;
    case Suspicion::confirmed:
      memory_.take_up(std::nullopt, detector_.since());
      succeed(decision, detector_.since());
      break;
    case Suspicion::none:
    case Suspicion::dismissed:
      break;
  }
}

// The vehicle as it was known, once it is back; else what is known of it now.
void AdaptiveSvr::remember(Decision& decision, double t) {
  if (const std::optional<std::size_t> known = memory_.fitting()) {
    const PastModel& past = memory_.models()[*known];
    const double since = memory_.since();
    decision.recalled = past.info.number;
    challenger().take_up(past, t);
    memory_.take_up(known, since);
    detector_.dismiss();
    ++tally_.recalls;
    succeed(decision, since);
  } else if (memory_.due() && champion().status().ready && !decision.unfinished) {
    memory_.keep(champion(), t);
  }
}

void AdaptiveSvr::restate(const SampleMap& map) {
  for (OnlineSvr& learner : learners_) {
    learner.restate(map);
  }
  looks_ = 0;
  if (!memory_.models().empty()) {
    detector_.dismiss();  // past models are solved in the challenger's place
    memory_.restate(map, [this](PastModel& past) { learn_anew(past); });
  }
}

bool AdaptiveSvr::add_past(const PastModel& past) {
  if (memory_.models().size() == memory_.capacity()) {
    return false;
  }
  PastModel known = past;
  learn_anew(known);
  memory_.add(known);
  return true;
}

void AdaptiveSvr::learn_anew(PastModel& past) {
  challenger().take_up(past, past.info.until_s);
  past.function = challenger().model();
}

void AdaptiveSvr::visit(Archive& archive) {
  archive.whole(champion_, 0, learners_.size() - 1);
  archive.part("change", detector_);
  archive.require(!detector_.trying() || learners_.size() > 1, "has a challenger without a place");
  archive.part("champion", champion());
  if (detector_.trying()) {
    archive.part("challenger", challenger());
  }
  archive.whole(looks_);
  archive.numbers(std::span(misfits_).first(std::min(looks_, kMisfits)));
  archive.number(usual_error_);
  archive.part("tally", tally_);
  archive.part("memory", memory_);
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

void AdaptiveSvr::succeed(Decision& decision, double since) {
  const int before = champion().status().buffer;
  champion_ = 1 - champion_;
  looks_ = 0;
  const Status status = champion().status();
  decision.forgotten += before - status.buffer;
  tally_.forgotten += before - status.buffer;
  ++tally_.changes;
  decision.changed = true;
  decision.changed_since = since;
  decision.kkt_gap = status.kkt_gap;
  decision.served = true;
}

}  // namespace kelpie
