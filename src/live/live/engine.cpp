// SPDX-License-Identifier: Apache-2.0
#include "live/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <thread>
#include <utility>

#include "core/seconds.hpp"
#include "kelpie/core/error.hpp"
#include "live/tuning.hpp"

namespace kelpie::live {
namespace {

std::optional<std::int64_t> origin_of(const std::optional<log::Reach>& reach,
                                      const std::optional<SavedRun>& saved) {
  if (reach) {
    return reach->origin_ns;
  }
  return saved && saved->progress.learned > 0 ? std::optional(saved->progress.origin_ns)
                                              : std::nullopt;
}

Row empty_row(const StreamPlan& plan) {
  Row row;
  row.x.resize(plan.inputs.size());
  row.y.resize(plan.targets.size());
  return row;
}

}  // namespace

Engine::Engine(const Configuration& configuration, std::filesystem::path folder,
               Transport& transport, std::optional<SavedRun> saved, Outputs& outputs,
               Requests& requests)
    : configuration_(configuration),
      transport_(transport),
      outputs_(outputs),
      requests_(requests),
      reach_(transport.reach()),
      receiver_(configuration, origin_of(reach_, saved)),
      learner_(configuration, std::move(folder), reach_, std::move(saved), outputs),
      row_(empty_row(configuration.plan)),
      queue_(kTuning.queued_rows, row_),
      commands_(configuration.plan.inputs, configuration.plan.rate_hz, configuration.plan.gap_s),
      reckoning_(configuration),
      x_now_(configuration.plan.inputs.size()),
      predictions_(configuration.plan.targets.size()) {}

void Engine::record(std::unique_ptr<Recorder> recorder) {
  if (recorder_) {
    recorder_->finish();
    unrecorded_ += recorder_->lost();
  }
  recorder_ = std::move(recorder);
  if (recorder_) {
    recorder_->begin_with(told_);
  }
}

void Engine::run(const std::function<Action()>& next_action) {
  std::thread learning([&] { learn(); });
  std::exception_ptr failed;
  try {
    receive(next_action);
  } catch (...) {
    failed = std::current_exception();
  }
  queue_.close(has_ended_ ? Clock::time_point::max() : Clock::now() + kTuning.longest_farewell);
  learning.join();
  record(nullptr);
  for (const std::exception_ptr& failure : {failed_, failed}) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
  // A recording's end isn't that of the vehicle's day: what waits there is learned for the model
  // alone, and the checkpoint goes on from before it.
  if (!reach_) {
    learner_.finish();
  }
  learner_.save();
  if (reach_ && has_ended_) {
    learner_.finish();
  }
  learner_.write_model();
  learner_.refresh_health();
}

void Engine::learn() {
  try {
    for (Row row = empty_row(configuration_.plan); queue_.pop(row);) {
      learner_.process(row);
    }
  } catch (...) {
    failed_ = std::current_exception();
    queue_.close();
  }
  learning_ended_ = true;
}

void Engine::receive(const std::function<Action()>& next_action) {
  while (next_action() == Action::proceed && !has_ended_ && !learning_ended_) {
    forward_request();
    bag::Message message;
    const Transport::Got got = transport_.next(message, kTuning.longest_wait);
    if (got == Transport::Got::message) {
      received_ns_ = message.receive_ns;
      if (recorder_) {
        recorder_->write(transport_.topics(), message);
      }
      told_.hear(transport_.topics(), message);
      receiver_.receive(transport_.topics(), message);
      if (outputs_.wants_predictions()) {
        predict();
      }
      reckon();
      forward_rows();
      last_message_ = Clock::now();  // a replay may have waited for the learner
    } else if (got == Transport::Got::end) {
      has_ended_ = true;
      finish_rows();
      report();
    }
    if (Clock::now() - reported_ > kTuning.between_reports) {
      report();
    }
  }
  if (!has_ended_ && !reach_) {
    finish_rows();  // for nobody will show these messages again
  }
  while ((row_.request = requests_.pop())) {
    queue_.push(row_, true);
  }
}

// A log ends with the first of its signals, which a stream can't know while they come.
void Engine::finish_rows() {
  const SampleStream& stream = receiver_.stream();
  for (std::size_t k = 0; !reach_ && k < configuration_.plan.sources.size(); ++k) {
    end_s_ = std::min(end_s_, stream.signal(k).newest_s());
  }
  receiver_.finish();
  forward_rows();
}

// No row lies later.
double Engine::last_row_s() const {
  const double rate_hz = configuration_.plan.rate_hz;
  const double end_s =
      reach_ ? reach_->end_s + seconds(reach_->origin_ns - receiver_.origin_ns().value_or(0))
             : end_s_;
  return std::floor(end_s * rate_hz + SampleStream::kRounding) / rate_hz;
}

void Engine::forward_rows() {
  const double last_row_s = this->last_row_s();
  while (const SampleRow* const row = receiver_.next()) {
    // After the first of a log's signals has ended, the others make rows that lack its value; a
    // command that is held for the gap is no value of the log.
    const bool is_beyond = row->t > last_row_s;
    if (is_beyond && row->t > receiver_.now_s()) {
      continue;
    }
    ++rows_;
    row_late_s_ = has_ended_ ? row_late_s_ : receiver_.now_s() - row->t;
    if (!is_beyond) {
      reckoning_.take_row(*row, receiver_, outputs_);
    }
    if (!row->is_whole || is_beyond) {
      note_incomplete();
      continue;
    }
    rows_in_vain_ = 0;
    no_rows_.clear();
    row_.t = row->t;
    row_.origin_ns = receiver_.origin_ns(row->t);
    std::ranges::copy(row->x, row_.x.begin());
    std::ranges::copy(row->y, row_.y.begin());
    row_.is_stuck = configuration_.live.frozen == Frozen::skip &&
                    (receiver_.is_stuck(row->t) || reckoning_.is_invalid(row->t));
    row_.wants_model = reckoning_.wants_model(row->t);
    row_.received_ns = received_ns_;
    row_.came = Clock::now();
    const bool is_kept = queue_.push(row_, reach_.has_value());
    models_wanted_ += row_.wants_model && is_kept ? 1 : 0;
  }
}

void Engine::note_incomplete() {
  ++rows_incomplete_;
  ++rows_in_vain_;
  const double lasted_s = static_cast<double>(rows_in_vain_) / configuration_.plan.rate_hz;
  if (no_rows_.empty() && lasted_s >= kTuning.longest_in_vain_s) {
    no_rows_ = fmt::format("no row has been whole for {:.0f} s", kTuning.longest_in_vain_s) +
               why_incomplete();
  }
}

// ": u comes at 1.0 Hz, its window of 1.2 s needs 3 samples"; empty: unknown.
std::string Engine::why_incomplete() const {
  constexpr std::size_t kIntervals = 3;
  const StreamPlan& plan = configuration_.plan;
  const SampleStream& stream = receiver_.stream();
  for (const StreamPlan::Derived& derived : plan.derived) {
    const SignalHistory& signal = stream.signal(plan.source(derived.of));
    if (signal.size() <= kIntervals) {
      continue;
    }
    const double lasted_s = signal.newest_s() - signal.time_s(signal.size() - 1 - kIntervals);
    const double rate_hz = static_cast<double>(kIntervals) / lasted_s;
    const int needed = plan.derivative.degree + 1;
    if (rate_hz * plan.derivative.window_s < needed) {
      return fmt::format(": {} comes at {:.1f} Hz, its window of {:.3g} s needs {} samples",
                         derived.of, rate_hz, plan.derivative.window_s, needed);
    }
  }
  for (std::size_t k = 0; k < plan.sources.size(); ++k) {
    if (receiver_.silent_s(k) > plan.gap_s) {
      return ": " + plan.sources[k].name + " is silent";
    }
  }
  return "";
}

// A replay waits for the learner, so that a model serves from the same message on as it did live.
void Engine::reckon() {
  if (reckoning_.is_due(receiver_.now_s())) {
    while (reach_ && learner_.models_given() < models_wanted_ && !learning_ended_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (learner_.models_given() >= models_wanted_) {
      reckoning_.use(learner_.reckoning_model());
    }
  }
  if (const auto sample = reckoning_.update(receiver_, received_ns_, outputs_)) {
    outputs_.reckoned(*sample);
  }
}

// One at a time: meanwhile equal requests join.
void Engine::forward_request() {
  if (queue_.has_request() || Clock::now() - forwarded_ < kTuning.between_requests) {
    return;
  }
  row_.request = requests_.pop();
  if (row_.request) {
    forwarded_ = Clock::now();
    queue_.push(row_, true);
    row_.request.reset();
  }
}

void Engine::predict() {
  commands_.use(learner_.alignment());
  const std::optional<std::int64_t>& origin_ns = receiver_.origin_ns();
  if (!origin_ns || !receiver_.inputs_at(receiver_.now_s(), commands_.shifts_s(), x_now_,
                                         reckoning_.late_inputs())) {
    return;
  }
  commands_.act(x_now_, receiver_.now_s());
  if (reckoning_.fill_late_inputs(x_now_) && learner_.model()->predict(x_now_, predictions_) > 0) {
    outputs_.predicted({.stamp_ns = received_ns_,
                        .data_ns = *origin_ns + nanoseconds(receiver_.now_s()),
                        .x = x_now_,
                        .predictions = predictions_});
  }
}

bool Engine::is_alive() {
  const std::size_t rows = learner_.rows_taken();
  if (rows != rows_seen_alive_ || queue_.size() == 0) {
    rows_seen_alive_ = rows;
    alive_ = Clock::now();
  }
  return Clock::now() - alive_ < kTuning.longest_row;
}

void Engine::report() {
  reported_ = Clock::now();
  Health now = health();
  measure_rates(now);
  for (const std::string& line : events_of(now, before_)) {
    outputs_.event(line);
  }
  outputs_.health(now);
  before_ = std::move(now);
  before_s_ = receiver_.now_s();
}

Health Engine::health() const {
  Health health;
  health.stamp_ns = received_ns_;
  const bool waits = reach_ && queue_.size() > 0;  // for the learner
  health.idle_s = has_ended_ || waits
                      ? 0.0
                      : std::chrono::duration<double>(Clock::now() - last_message_).count();
  health.transport = transport_.health();
  health.topics = receiver_.topics();
  const SampleStream& stream = receiver_.stream();
  for (std::size_t k = 0; k < configuration_.plan.sources.size(); ++k) {
    const StreamPlan::Source& source = configuration_.plan.sources[k];
    health.sources.push_back({.name = source.name,
                              .from = source.from,
                              .silent_s = receiver_.silent_s(k),
                              .gap_s = configuration_.plan.gap_s,
                              .is_stuck = stream.signal(k).is_stuck(),
                              .faults = stream.signal(k).faults()});
  }
  health.clock_restarts = stream.restarts();
  health.rows = rows_;
  health.rows_incomplete = rows_incomplete_;
  health.no_rows = no_rows_;
  health.row_late_s = row_late_s_;
  health.rows_dropped = reach_ ? 0 : queue_.dropped();  // a recording shows its rows again
  health.rows_waiting = queue_.size();
  health.record_error = recorder_ ? recorder_->error() : "";
  health.unrecorded = unrecorded_ + (recorder_ ? recorder_->lost() : 0);
  health.reckoning = reckoning_.health();
  health.learner = learner_.health();
  return health;
}

void Engine::measure_rates(Health& health) const {
  const double time_s = receiver_.now_s() - before_s_;
  for (std::size_t k = 0; k < health.sources.size() && k < before_.sources.size(); ++k) {
    const std::size_t samples =
        health.sources[k].faults.samples - before_.sources[k].faults.samples;
    health.sources[k].rate_hz = time_s > 0.0 ? static_cast<double>(samples) / time_s : 0.0;
  }
}

}  // namespace kelpie::live
