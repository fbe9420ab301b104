// SPDX-License-Identifier: Apache-2.0
#include "learner/adaptive_svr.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include "learner/tuning.hpp"

namespace kelpie {
namespace {

// The number of the earliest sample with this or a later arrival.
std::optional<std::size_t> first_since(std::span<const std::uint64_t> arrivals,
                                       std::uint64_t since) {
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (arrivals[i] >= since && (!first || arrivals[i] < arrivals[*first])) {
      first = i;
    }
  }
  return first;
}

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
      change_(learners_.size(), TermChange(inputs, terms)),
      model_(champion().buffer().kernel(), learners_.size() > 1 ? settings.places() : 0),
      past_models_(learners_.front().buffer(), settings),
      misfit_(kOnline.change.least_misfits, kOnline.change.misfit_every),
      sample_(inputs + terms),
      draft_(champion().buffer().kernel(), learners_.size() > 1 ? settings.places() : 0) {}

std::size_t AdaptiveSvr::bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                               std::size_t terms) {
  const std::size_t one = OnlineSvr::bytes(inputs, settings, terms);
  const bool two = settings.adapt == AdaptRule::challenger;
  return sizeof(AdaptiveSvr) + (inputs + terms) * sizeof(double) + (two ? 2 * one : one) +
         PastModel::bytes(inputs, terms, two ? settings.places() : 0) +
         (two ? 2 : 1) * (sizeof(TermChange) + (terms + 1) * sizeof(double)) +
         SvrFunction::bytes(inputs, terms, two ? settings.places() : 0) +
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
  const double error = adaptive ? error_without_short_range(champion_, z, y) : 0.0;
  const double other = trying ? error_without_short_range(1 - champion_, z, y) : 0.0;
  Decision decision = mutable_champion().update(z, y - change()(z), t);
  add_change();  // a copy for later has the function of this sample
  if (adaptive && decision.verdict != Verdict::invalid && decision.had_model) {
    const bool comparable = trying && teach_challenger(z, y, t);
    if (task_ != SliceTask::recall) {
      past_models_.observe(z, y, std::abs(error), t);
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
  add_change();
  tally_.add(decision);
  return decision;
}

void AdaptiveSvr::shift(std::span<const double> step, const Decision& news) {
  detector_.dismiss();  // errors until now are of the vehicle before
  if (!step.empty() && news.changed) {
    past_models_.promote_challenger(news.changed_since);
  } else if (!step.empty() && news.withdrawn) {
    past_models_.withdraw();
  } else {
    past_models_.settle();
  }
  tally_.changes += news.changed ? 1 : 0;
  tally_.withdrawn += news.withdrawn ? 1 : 0;
  if (!step.empty()) {
    change_[champion_].add(step);
    add_change();
  }
}

void AdaptiveSvr::add_change() {
  if (change().any()) {
    model_.assign(champion().model());
    model_.add(change().weights());
  }
}

// Whether its error says something: it had a model, and hadn't been at this place.
bool AdaptiveSvr::teach_challenger(std::span<const double> z, double y, double t) {
  challenger().limit(budget_.split_half());
  const Decision step = challenger().update(z, y - change_[1 - champion_](z), t);
  return step.had_model && step.similarity < kOnline.memory.same_place;
}

// Measures the misfit at one sample of the champion's buffer, the next at every update.
void AdaptiveSvr::measure_misfit() {
  const SampleCollector& buffer = champion().buffer();
  if (champion().ready() && buffer.size() >= kOnline.change.least_misfits) {
    const std::size_t i = misfit_.count() % buffer.size();
    buffer.samples().get(i, sample_);
    misfit_.add(buffer.problem().targets()[i] - champion().model().without_short_range(sample_));
  }
}

// More than the champion is off one step ahead: a measure of what it doesn't know at all.
double AdaptiveSvr::usual_misfit() const {
  if (!champion().ready() || champion().buffer().size() < kOnline.change.least_misfits) {
    return std::numeric_limits<double>::infinity();
  }
  // An error within half the tube is none.
  return std::max(misfit_.value(), 0.5 * settings().epsilon);
}

void AdaptiveSvr::detect_change(Decision& decision, const ChangeDetector::Errors& errors,
                                double t) {
  switch (detector_.inspect(errors, usual_misfit(), t)) {
    case Suspicion::raised:
      clear_challenger();
      decision.suspected = true;
      break;
    case Suspicion::confirmed:
      past_models_.promote_challenger(detector_.since());
      declare_change(decision, detector_.since());
      break;
    case Suspicion::withdrawn:
      past_models_.withdraw();
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
  if (const std::optional<std::size_t> known = past_models_.fitting()) {
    start(SliceTask::recall);
    past_ = *known;
    begun_s_ = t;
    since_s_ = past_models_.since();
    decision.returning = true;
    decision.changed_since = since_s_;
  } else if (past_models_.due() && !detector_.trying() && champion().ready() &&
             !decision.unfinished) {
    past_models_.keep(champion(), model(), change(), t);
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

void AdaptiveSvr::start(SliceTask task) {
  task_ = task;
  detector_.dismiss();
  clear_challenger();
}

void AdaptiveSvr::clear_challenger() {
  challenger().clear();
  change_[1 - champion_].clear();
}

void AdaptiveSvr::recall(Decision& decision) {
  challenger().limit(budget_.split_half());
  const PastModel& past = past_models_.models()[past_];
  bool ready = false;
  for (int k = 0; k < kOnline.task.recall_slices && !ready; ++k) {
    ready = challenger().relearn_slice(past, begun_s_);
  }
  if (ready) {
    task_ = SliceTask::none;
    decision.recalled = past.info.number;
    detector_.start_probation(past.info.usual_error);
    past_models_.recall(past_, since_s_);
    declare_change(decision, since_s_);
  }
}

RescaleStatus AdaptiveSvr::rescale(const SampleMap& map) {
  if (learners_.size() == 1) {
    return rescale_at_once(map);
  }
  challenger().limit(budget_.split_half());
  const SampleCollector& buffer = champion().buffer();
  switch (task_) {
    case SliceTask::none:
      start(SliceTask::rescale);
      draft_.keep(buffer, champion().model(), {.usual_error = 1.0});  // a state holds none of 0
      learned_ = buffer.next_arrival();
      if (buffer.size() == settings().places()) {
        --learned_;  // the draft is a sample more than a learner takes up: the latest
      }
      [[fallthrough]];
    case SliceTask::rescale:
      if (challenger().relearn_slice(draft_, draft_.latest_s(), map)) {
        task_ = SliceTask::catch_up;
      }
      return RescaleStatus::under_way;
    case SliceTask::catch_up:
      return catch_up(map);
    case SliceTask::follow:
      return follow(map);
    case SliceTask::recall:
      break;
  }
  return RescaleStatus::under_way;
}

RescaleStatus AdaptiveSvr::rescale_at_once(const SampleMap& map) {
  if (task_ == SliceTask::follow) {
    task_ = SliceTask::none;
    return RescaleStatus::done;
  }
  mutable_champion().rescale(map);
  misfit_.clear();
  task_ = SliceTask::follow;  // there are no past models
  return RescaleStatus::switched;
}

// Takes over once nothing is left to learn.
RescaleStatus AdaptiveSvr::catch_up(const SampleMap& map) {
  const SampleCollector& buffer = champion().buffer();
  std::optional<std::size_t> next = first_since(buffer.arrivals(), learned_);
  for (int k = 0; k < kOnline.task.caught_up && next; ++k) {
    buffer.samples().get(*next, sample_);
    double y = buffer.problem().targets()[*next];
    map(sample_, y);
    if (challenger().update(sample_, y, buffer.time(*next)).verdict == Verdict::crowded_out) {
      break;
    }
    learned_ = buffer.arrivals()[*next] + 1;
    next = first_since(buffer.arrivals(), learned_);
  }
  if (next) {
    return RescaleStatus::under_way;
  }
  change_[1 - champion_] = change();
  change_[1 - champion_].rescale(map, sample_);
  Decision step;
  promote(step);
  add_change();
  tally_.forgotten += step.forgotten;
  tally_.regained += step.regained;
  past_models_.rescale(map);
  start(SliceTask::follow);
  past_ = 0;
  return RescaleStatus::switched;
}

RescaleStatus AdaptiveSvr::follow(const SampleMap& map) {
  if (past_ == past_models_.models().size()) {
    past_models_.finish_rescale();
    task_ = SliceTask::none;
    return RescaleStatus::done;
  }
  const PastModel& past = past_models_.models()[past_];
  if (challenger().relearn_slice(past, past.info.until_s, map)) {
    past_models_.rescale_model(past_++, map, challenger().model());
    clear_challenger();
  }
  return RescaleStatus::under_way;
}

bool AdaptiveSvr::add_past(const PastModel& past) {
  if (past_models_.models().size() == past_models_.capacity()) {
    return false;
  }
  PastModel known = past;
  challenger().relearn(known, known.info.until_s);
  known.function = challenger().model();
  past_models_.add(known);
  return true;
}

void AdaptiveSvr::visit(Archive& archive) {
  archive.whole(champion_, 0, learners_.size() - 1);
  archive.part("change", detector_);
  archive.require(!detector_.trying() || learners_.size() > 1, "has a challenger without a place");
  archive.part("champion", mutable_champion());
  std::ranges::for_each(change_, [&](TermChange& change) { archive.part("since", change); });
  visit_task(archive);
  if (learners_.size() > 1 && (detector_.trying() || task_ != SliceTask::none)) {
    archive.part("challenger", challenger());
  }
  archive.part("misfit", misfit_);
  archive.part("tally", tally_);
  archive.part("memory", past_models_);
  const bool of_a_past_model = task_ == SliceTask::follow ? past_ <= past_models_.models().size()
                                                          : past_ < past_models_.models().size();
  archive.require(of_a_past_model || (task_ != SliceTask::follow && task_ != SliceTask::recall),
                  "learns a past model that there isn't");
  if (archive.loading()) {
    add_change();
  }
}

void AdaptiveSvr::visit_task(Archive& archive) {
  archive.choice(task_, SliceTask{}, SliceTask::recall);
  archive.require(learners_.size() > 1 || task_ == SliceTask::none || task_ == SliceTask::follow,
                  "has a task without a place");
  if (task_ == SliceTask::rescale) {
    archive.part("draft", draft_);
  }
  archive.whole(learned_);
  archive.whole(past_);
  archive.number(begun_s_);
  archive.number(since_s_);
}

double AdaptiveSvr::predict(std::span<const double> z) const noexcept {
  return champion().predict(z) + change()(z);
}

Status AdaptiveSvr::status() const {
  Status status = champion().status();
  status.tally = tally_;
  return status;
}

// The error beyond the moment: what the fine part follows, that of a challenger follows as well.
double AdaptiveSvr::error_without_short_range(std::size_t learner, std::span<const double> z,
                                              double y) const {
  const OnlineSvr& svr = learners_[learner];
  const bool known = svr.ready() && z.size() == svr.model().kernel().dimension();
  return known ? y - change_[learner](z) - svr.model().without_short_range(z) : 0.0;
}

}  // namespace kelpie
