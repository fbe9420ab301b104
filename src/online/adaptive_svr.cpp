// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/adaptive_svr.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace kelpie {
namespace {

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
      sample_(inputs + terms),
      draft_(champion().buffer().kernel(), learners_.size() > 1 ? settings.places() : 0) {}

std::size_t AdaptiveSvr::bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                               std::size_t terms) {
  const std::size_t one = OnlineSvr::bytes(inputs, settings, terms);
  const bool two = settings.adapt == AdaptRule::challenger;
  return sizeof(AdaptiveSvr) + (inputs + terms) * sizeof(double) + (two ? 2 * one : one) +
         PastModel::bytes(inputs, terms, two ? settings.places() : 0) +
         PastModels::bytes(inputs, terms, settings);
}

void AdaptiveSvr::limit(const Budget& budget) {
  budget_ = budget;
  for (OnlineSvr& learner : learners_) {
    learner.limit(budget);
  }
}

Decision AdaptiveSvr::update(std::span<const double> z, double y, double t,
                             double committee_error) noexcept {
  const bool adaptive = learners_.size() > 1;
  const bool trying = detector_.trying();
  const double error = adaptive ? error_without_short_range(champion(), z, y) : 0.0;
  const double other = trying ? error_without_short_range(challenger(), z, y) : 0.0;
  Decision decision = champion().update(z, y, t);
  if (adaptive && decision.verdict != Verdict::invalid && decision.had_model) {
    const bool comparable = trying && teach_challenger(z, y, t);
    if (task_ != SliceTask::recall) {
      memory_.observe(z, y, error, t);
    }
    measure_misfit();
    if (task_ == SliceTask::none) {
      detect_change(decision,
                    {.champion = error,
                     .challenger = comparable ? std::optional(other) : std::nullopt,
                     .all = committee_error},
                    t);
      if (!decision.changed && !decision.withdrawn) {
        manage_past_models(decision, t);
      }
    }
    if (task_ == SliceTask::recall) {
      recall(decision);
    }
  }
  tally_.add(decision);
  return decision;
}

// Whether its error says something: it had a model, and hadn't been at this place.
bool AdaptiveSvr::teach_challenger(std::span<const double> z, double y, double t) {
  challenger().limit(budget_.split_half());
  const Decision step = challenger().update(z, y, t);
  return step.had_model && step.similarity < kSamePlace;
}

// Measures the misfit at one sample of the champion's buffer, the next at every update.
void AdaptiveSvr::measure_misfit() {
  const SampleCollector& buffer = champion().buffer();
  if (champion().ready() && buffer.size() >= kLeastMisfits) {
    const std::size_t i = misfit_.count() % buffer.size();
    buffer.samples().get(i, sample_);
    misfit_.add(buffer.problem().targets()[i] - champion().model().without_short_range(sample_));
  }
}

// More than the champion is off one step ahead: a measure of what it doesn't know at all.
double AdaptiveSvr::usual_misfit() const {
  if (!champion().ready() || champion().buffer().size() < kLeastMisfits) {
    return std::numeric_limits<double>::infinity();
  }
  // An error within half the tube is none.
  return std::max(misfit_.value(), 0.5 * settings().epsilon);
}

void AdaptiveSvr::detect_change(Decision& decision, const ChangeDetector::Errors& errors,
                                double t) {
  switch (detector_.inspect(errors, usual_misfit(), t)) {
    case Suspicion::raised:
      challenger().clear();
      decision.suspected = true;
      break;
    case Suspicion::confirmed:
      memory_.promote_challenger(detector_.since());
      declare_change(decision, detector_.since());
      break;
    case Suspicion::withdrawn:
      memory_.withdraw();
      promote(decision);
      decision.withdrawn = true;
      break;
    case Suspicion::none:
    case Suspicion::dismissed:
      break;
  }
}

// Takes up the past model that fits; without one, keeps the champion when it is time to.
void AdaptiveSvr::manage_past_models(Decision& decision, double t) {
  if (const std::optional<std::size_t> known = memory_.fitting()) {
    start(SliceTask::recall);
    past_ = *known;
    begun_s_ = t;
    since_s_ = memory_.since();
    decision.returning = true;
    decision.changed_since = since_s_;
  } else if (memory_.due() && !detector_.trying() && champion().ready() && !decision.unfinished) {
    memory_.keep(champion(), t);
  }
}

void AdaptiveSvr::declare_change(Decision& decision, double since) {
  promote(decision);
  decision.changed = true;
  decision.changed_since = since;
}

// The other learner becomes the champion.
void AdaptiveSvr::promote(Decision& decision) {
  const auto before = static_cast<int>(champion().buffer().size());
  champion_ = 1 - champion_;
  misfit_.clear();
  const Status status = champion().status();
  decision.forgotten += std::max(before - status.buffer, 0);
  decision.regained += std::max(status.buffer - before, 0);
  decision.kkt_gap = status.kkt_gap;
  decision.published = true;
}

bool AdaptiveSvr::add_past(const PastModel& past) {
  if (memory_.models().size() == memory_.capacity()) {
    return false;
  }
  PastModel known = past;
  challenger().relearn(known, known.info.until_s);
  known.function = challenger().model();
  memory_.add(known);
  return true;
}

void AdaptiveSvr::visit(Archive& archive) {
  archive.whole(champion_, 0, learners_.size() - 1);
  archive.part("change", detector_);
  archive.require(!detector_.trying() || learners_.size() > 1, "has a challenger without a place");
  archive.part("champion", champion());
  visit_task(archive);
  if (learners_.size() > 1 && (detector_.trying() || task_ != SliceTask::none)) {
    archive.part("challenger", challenger());
  }
  archive.part("misfit", misfit_);
  archive.part("tally", tally_);
  archive.part("memory", memory_);
  const bool of_a_past_model = task_ == SliceTask::follow ? past_ <= memory_.models().size()
                                                          : past_ < memory_.models().size();
  archive.require(of_a_past_model || (task_ != SliceTask::follow && task_ != SliceTask::recall),
                  "learns a past model that there isn't");
}

double AdaptiveSvr::predict(std::span<const double> z) const noexcept {
  return champion().predict(z);
}

Status AdaptiveSvr::status() const {
  Status status = champion().status();
  status.tally = tally_;
  return status;
}

// The error beyond the moment: what the fine part follows, that of a challenger follows as well.
double AdaptiveSvr::error_without_short_range(const OnlineSvr& learner, std::span<const double> z,
                                              double y) {
  const bool known = learner.ready() && z.size() == learner.model().kernel().dimension();
  return known ? std::abs(y - learner.model().without_short_range(z)) : 0.0;
}

}  // namespace kelpie
