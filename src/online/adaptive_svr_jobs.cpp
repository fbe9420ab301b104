// SPDX-License-Identifier: Apache-2.0
// The part of AdaptiveSvr that does long jobs in the challenger's place.
#include <optional>

#include "kelpie/online/adaptive_svr.hpp"

namespace kelpie {
namespace {

constexpr int kCaughtUp = 2;      // samples per update: one more than can come
constexpr int kRecallSlices = 3;  // per update: until it is done predictions are poor

}  // namespace

void AdaptiveSvr::begin(Job job) {
  job_ = job;
  detector_.dismiss();
  challenger().clear();
}

void AdaptiveSvr::recall(Decision& decision) {
  challenger().limit(budget_.leaving_half());
  const PastModel& past = memory_.models()[past_];
  bool ready = false;
  for (int k = 0; k < kRecallSlices && !ready; ++k) {
    ready = challenger().take_up_slice(past, begun_s_);
  }
  if (ready) {
    job_ = Job::none;
    decision.recalled = past.info.number;
    detector_.prove(past.info.usual_error);
    memory_.take_up_past(past_, since_s_);
    succeed(decision, since_s_);
  }
}

Passage AdaptiveSvr::restate(const SampleMap& map) {
  if (learners_.size() == 1) {
    return restate_at_once(map);
  }
  challenger().limit(budget_.leaving_half());
  const SampleCollector& buffer = champion().buffer();
  switch (job_) {
    case Job::none:
      begin(Job::restate);
      draft_.keep(buffer, champion().model(), {.usual_error = 1.0});  // a state holds none of 0
      learned_ = buffer.next_arrival();
      if (buffer.size() == settings().places()) {
        --learned_;  // the draft is a sample more than a learner takes up: the latest
      }
      [[fallthrough]];
    case Job::restate:
      if (challenger().take_up_slice(draft_, draft_.latest_s(), map)) {
        job_ = Job::catch_up;
      }
      return Passage::under_way;
    case Job::catch_up:
      return catch_up(map);
    case Job::follow:
      return follow(map);
    case Job::recall:
      break;
  }
  return Passage::under_way;
}

Passage AdaptiveSvr::restate_at_once(const SampleMap& map) {
  if (job_ == Job::follow) {
    job_ = Job::none;
    return Passage::done;
  }
  champion().restate(map);
  misfit_.clear();
  job_ = Job::follow;  // there are no past models
  return Passage::arrived;
}

// Takes over once nothing is left to learn.
Passage AdaptiveSvr::catch_up(const SampleMap& map) {
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
    return Passage::under_way;
  }
  Decision step;
  take_over(step);
  tally_.forgotten += step.forgotten;
  tally_.regained += step.regained;
  memory_.restate(map);
  begin(Job::follow);
  past_ = 0;
  return Passage::arrived;
}

Passage AdaptiveSvr::follow(const SampleMap& map) {
  if (past_ == memory_.models().size()) {
    memory_.catch_up();
    job_ = Job::none;
    return Passage::done;
  }
  const PastModel& past = memory_.models()[past_];
  if (challenger().take_up_slice(past, past.info.until_s, map)) {
    memory_.restate(past_++, map, challenger().model());
    challenger().clear();
  }
  return Passage::under_way;
}

void AdaptiveSvr::visit_job(Archive& archive) {
  auto job = static_cast<int>(job_);
  archive.whole(job, 0, static_cast<int>(Job::recall));
  job_ = static_cast<Job>(job);
  archive.require(learners_.size() > 1 || job_ == Job::none || job_ == Job::follow,
                  "has a job without a place");
  if (job_ == Job::restate) {
    archive.part("draft", draft_);
  }
  archive.whole(learned_);
  archive.whole(past_);
  archive.number(begun_s_);
  archive.number(since_s_);
}

}  // namespace kelpie
