// SPDX-License-Identifier: Apache-2.0
// The part of AdaptiveSvr that does long jobs in the challenger's place.
#include <optional>

#include "kelpie/online/adaptive_svr.hpp"

namespace kelpie {
namespace {

constexpr int kCaughtUp = 2;      // samples per update: one more than can come
constexpr int kRecallSlices = 3;  // per update: until it is done predictions are poor

}  // namespace

void AdaptiveSvr::start(SliceTask task) {
  task_ = task;
  detector_.dismiss();
  challenger().clear();
}

void AdaptiveSvr::recall(Decision& decision) {
  challenger().limit(budget_.split_half());
  const PastModel& past = memory_.models()[past_];
  bool ready = false;
  for (int k = 0; k < kRecallSlices && !ready; ++k) {
    ready = challenger().relearn_slice(past, begun_s_);
  }
  if (ready) {
    task_ = SliceTask::none;
    decision.recalled = past.info.number;
    detector_.start_probation(past.info.usual_error);
    memory_.recall(past_, since_s_);
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
  champion().rescale(map);
  misfit_.clear();
  task_ = SliceTask::follow;  // there are no past models
  return RescaleStatus::switched;
}

// Takes over once nothing is left to learn.
RescaleStatus AdaptiveSvr::catch_up(const SampleMap& map) {
  const SampleCollector& buffer = champion().buffer();
  std::optional<std::size_t> next = buffer.first_since(learned_);
  for (int k = 0; k < kCaughtUp && next; ++k) {
    buffer.samples().get(*next, sample_);
    double y = buffer.problem().targets()[*next];
    map(sample_, y);
    if (challenger().update(sample_, y, buffer.time(*next)).verdict == Verdict::crowded_out) {
      break;
    }
    learned_ = buffer.arrival(*next) + 1;
    next = buffer.first_since(learned_);
  }
  if (next) {
    return RescaleStatus::under_way;
  }
  Decision step;
  promote(step);
  tally_.forgotten += step.forgotten;
  tally_.regained += step.regained;
  memory_.rescale(map);
  start(SliceTask::follow);
  past_ = 0;
  return RescaleStatus::switched;
}

RescaleStatus AdaptiveSvr::follow(const SampleMap& map) {
  if (past_ == memory_.models().size()) {
    memory_.finish_rescale();
    task_ = SliceTask::none;
    return RescaleStatus::done;
  }
  const PastModel& past = memory_.models()[past_];
  if (challenger().relearn_slice(past, past.info.until_s, map)) {
    memory_.rescale_model(past_++, map, challenger().model());
    challenger().clear();
  }
  return RescaleStatus::under_way;
}

void AdaptiveSvr::visit_task(Archive& archive) {
  auto job = static_cast<int>(task_);
  archive.whole(job, 0, static_cast<int>(SliceTask::recall));
  task_ = static_cast<SliceTask>(job);
  archive.require(learners_.size() > 1 || task_ == SliceTask::none || task_ == SliceTask::follow,
                  "has a job without a place");
  if (task_ == SliceTask::rescale) {
    archive.part("draft", draft_);
  }
  archive.whole(learned_);
  archive.whole(past_);
  archive.number(begun_s_);
  archive.number(since_s_);
}

}  // namespace kelpie
