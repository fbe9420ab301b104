// SPDX-License-Identifier: Apache-2.0
#include "live/learner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "file/atomic_file.hpp"
#include "format/model_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/quantile.hpp"
#include "kelpie/core/text.hpp"
#include "live/shift.hpp"

namespace kelpie::live {
namespace {

constexpr std::size_t kJudged = 600;   // samples: a minute of 10 Hz
constexpr std::size_t kDelays = 1000;  // rows
constexpr std::chrono::seconds kBetweenHealths{1};

DynamicsModel fresh_model(const Configuration& configuration) {
  return {configuration.plan.inputs, configuration.plan.targets, configuration.settings};
}

DynamicsModel first_model(const Configuration& configuration,
                          const std::optional<SavedRun>& saved) {
  if (!saved) {
    return fresh_model(configuration);
  }
  try {
    return DynamicsModel::resume(fresh_model(configuration), saved->model);
  } catch (const InputError& error) {
    throw InputError({.file = saved->file, .line = 0, .field = {}}, error.what());
  }
}

}  // namespace

Learner::Learner(const Configuration& configuration, std::filesystem::path folder,
                 const std::optional<log::Reach>& recording, std::optional<SavedRun> saved,
                 Output& output)
    : configuration_(configuration),
      folder_(std::move(folder)),
      output_(output),
      model_(std::make_shared<SharedModel>(first_model(configuration, saved))),
      alignment_(configuration.plan.inputs, configuration.plan.targets.size(),
                 configuration.plan.rate_hz, configuration.settings.shared.states,
                 rows_to_keep(configuration.plan, recording)),
      said_(configuration.plan.targets.size(), Recent<Said>(kJudged)),
      delays_ms_(kDelays),
      checkpoint_s_(configuration.live.checkpoint_s),
      shifts_s_(configuration.plan.inputs.size()) {
  if (saved) {
    progress_ = saved->progress;
  }
  const bool is_same_recording = saved && recording && progress_.recording == *recording;
  known_rows_ = is_same_recording ? progress_.rows : 0;
  progress_.rows = 0;
  progress_.recording = recording.value_or(log::Reach{});
  was_ready_ = model()->model().ready();
  begin_alignment(is_same_recording, saved);
  refresh_health();
}

void Learner::begin_alignment(bool is_same_recording, const std::optional<SavedRun>& saved) {
  const std::string& wish = configuration_.live.align;
  double seconds = 0.0;
  looks_ = wish == "auto";
  if (parse_number(wish, seconds)) {
    alignment_.use({.alignment = alignment_of(configuration_, seconds), .gain = 0.0, .why = {}});
  } else if (saved && looks_ && !is_same_recording) {
    alignment_.use({.alignment = saved->alignment, .gain = 0.0, .why = {}});
  }
  publish_alignment();
}

void Learner::take(const Row& row) {
  if (row.request) {
    obey(*row.request);
    return;
  }
  ++progress_.rows;
  progress_.received_ns = row.received_ns;
  pass(row);
  last_t_s_ = row.t;
  const auto now = std::chrono::steady_clock::now();
  delays_ms_.add(std::chrono::duration<double, std::milli>(now - row.came).count());
  if (!has_saved_) {
    has_saved_ = true;
    saved_t_s_ = row.t;
  }
  if (!is_known() && !(std::abs(row.t - saved_t_s_) < checkpoint_s_)) {
    save();
  }
  rows_taken_.fetch_add(1);
  if (now - refreshed_ > kBetweenHealths) {
    refresh_health();
  }
}

void Learner::pass(const Row& row) {
  if (row.is_frozen != is_frozen_) {
    is_frozen_ = row.is_frozen;
    output_.said(fmt::format("at {:.1f} s: {}", row.t,
                             is_frozen_ ? "a velocity is frozen; rows aren't learned"
                                        : "velocities change again; rows are learned"));
  }
  if (progress_.is_paused && !is_known()) {
    ++paused_;
  } else if (row.is_frozen) {
    ++frozen_;
  } else {
    alignment_.push(row.x, row.y, row.t, [&](auto x, auto y, double t) { learn(x, y, t); });
    if (looks_ && alignment_.is_due()) {
      look_at_alignment(false);
    }
  }
}

void Learner::obey(Request request) {
  switch (request) {
    case Request::save:
      save_all();
      break;
    case Request::freeze:
    case Request::resume:
      progress_.is_paused = request == Request::freeze;
      output_.said(progress_.is_paused ? "learning is frozen: the model stays as it is"
                                       : "learning goes on");
      break;
    case Request::reset:
      begin_anew();
      output_.said("the model begins anew");
      break;
  }
  refresh_health();
}

void Learner::save_all() {
  save();
  if (!health().checkpoint_error.empty()) {
    return;
  }
  try {
    write_model();
    output_.said(fmt::format("saved, after {} samples", progress_.learned));
  } catch (const Failure& failure) {
    output_.said(std::string("no model could be written, learning goes on: ") + failure.what());
  }
}

void Learner::begin_anew() {
  model_.store(std::make_shared<SharedModel>(fresh_model(configuration_)));
  progress_.clock = {};
  progress_.learned = 0;
  was_ready_ = false;
  std::ranges::fill(said_, Recent<Said>(kJudged));
}

void Learner::learn(std::span<const double> x, std::span<const double> y, double t) {
  if (is_known()) {
    return;
  }
  update(x, y, t);
  tell_changes(t);
  output_.learned({.stamp_ns = origin_ns_ + static_cast<std::int64_t>(std::llround(t * 1e9)),
                   .x = x,
                   .y = y,
                   .decisions = model_.load()->model().decisions()});
}

void Learner::update(std::span<const double> x, std::span<const double> y, double t) {
  SharedModel& shared = *model_.load();
  shared.update(x, y, progress_.clock.at(t));
  ++progress_.learned;
  judge(y);
}

void Learner::judge(std::span<const double> y) {
  const std::span<const Decision> decisions = model_.load()->model().decisions();
  for (std::size_t i = 0; i < y.size(); ++i) {
    const Decision& decision = decisions[i];
    if (decision.had_model) {
      said_[i].add({.predicted = decision.predicted,
                    .truth = y[i],
                    .is_inside = decision.lower <= y[i] && y[i] <= decision.upper});
    }
  }
}

void Learner::tell_changes(double t) {
  const DynamicsModel& model = model_.load()->model();
  if (!was_ready_ && model.ready()) {
    was_ready_ = true;
    output_.said(
        fmt::format("at {:.1f} s: a model is in service, after {} samples", t, progress_.learned));
  }
  for (std::size_t i = 0; i < model.axes(); ++i) {
    const Decision& decision = model.decisions()[i];
    const std::string& axis = configuration_.plan.targets[i];
    if (decision.changed) {
      output_.said(fmt::format(
          "at {:.1f} s: {}: the vehicle has changed{}", t, axis,
          decision.recalled > 0 ? fmt::format("; past model {} fits", decision.recalled) : ""));
    }
    if (decision.withdrawn) {
      output_.said(fmt::format("at {:.1f} s: {}: the last change was none", t, axis));
    }
  }
}

void Learner::look_at_alignment(bool afresh) {
  const AlignmentFound found = alignment_.look(afresh);
  if (!alignment_.use(found)) {
    return;
  }
  publish_alignment();
  if (is_known()) {
    return;
  }
  output_.said(shift_text(alignment_.alignment()) + ": " + found.why +
               "; the model begins anew with the rows kept");
  begin_anew();
  alignment_.replay([&](auto x, auto y, double t) { update(x, y, t); });
}

void Learner::finish() {
  known_rows_ = 0;  // those that wait haven't been learned, whatever the checkpoint has
  if (looks_ && progress_.recording != log::Reach{}) {
    look_at_alignment(true);
  }
  alignment_.finish([&](auto x, auto y, double t) { learn(x, y, t); });
}

void Learner::save() {
  if (known_rows_ > 0 && is_known()) {
    return;  // the one on the disk is further
  }
  const bool was_well = health().checkpoint_error.empty();
  std::string error;
  try {
    progress_.origin_ns = origin_ns_;
    write_checkpoint(folder_, configuration_,
                     {.progress = progress_,
                      .alignment = alignment_.alignment(),
                      .model = model()->model().save(),
                      .file = {},
                      .note = {}});
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  saved_t_s_ = last_t_s_;
  if (error.empty() != was_well) {
    output_.said(error.empty() ? "checkpoints are written again"
                               : "no checkpoint can be written, learning goes on: " + error);
  }
  const std::lock_guard lock(mutex_);
  health_.checkpoint_error = error;
  if (error.empty()) {
    ++health_.checkpoints;
    health_.checkpoint_t_s = last_t_s_;
  } else {
    ++health_.checkpoints_failed;
  }
}

bool Learner::write_model() const {
  const DynamicsModel& model = this->model()->model();
  if (!model.ready()) {
    return false;
  }
  TrainedModel trained = model.trained();
  trained.alignment = alignment_.alignment();
  file::write_file_whole(folder_ / "model.json", format::model_json(trained));
  return true;
}

void Learner::publish_alignment() {
  const Alignment& alignment = alignment_.alignment();
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < shifts_s_.size(); ++i) {
    const bool is_shifted = std::ranges::find(alignment.commands, configuration_.plan.inputs[i]) !=
                            alignment.commands.end();
    shifts_s_[i] = is_shifted ? alignment.shift_s : 0.0;
  }
}

void Learner::shifts(std::span<double> shift_s) const {
  const std::lock_guard lock(mutex_);
  std::ranges::copy(shifts_s_, shift_s.begin());
}

LearnerHealth Learner::health() const {
  const std::lock_guard lock(mutex_);
  return health_;
}

void Learner::refresh_health() {
  const std::shared_ptr<const SharedModel> shared = model();
  const DynamicsModel& model = shared->model();
  std::vector<AxisHealth> axes;
  for (std::size_t i = 0; i < model.axes(); ++i) {
    const DynamicsAxis& axis = model.axis(i);
    AxisHealth& health = axes.emplace_back();
    health.name = configuration_.plan.targets[i];
    health.status = axis.status();
    health.r2 = r_squared(said_[i].values());
    health.coverage = coverage(said_[i].values());
    health.disturbance = model.decisions()[i].disturbance;
    if (health.status.ready) {
      health.coefficients = axis.coefficients();
    }
  }
  std::vector<double> delays_ms = delays_ms_.values();
  const std::lock_guard lock(mutex_);
  health_.rows = progress_.rows;
  health_.learned = progress_.learned;
  health_.frozen = frozen_;
  health_.is_paused = progress_.is_paused;
  health_.paused = paused_;
  health_.alignment = alignment_.alignment();
  health_.axes = std::move(axes);
  health_.last_t_s = last_t_s_;
  if (!delays_ms.empty()) {
    health_.median_delay_ms = quantile(delays_ms, 0.5);
    health_.longest_delay_ms = std::ranges::max(delays_ms);
  }
  refreshed_ = std::chrono::steady_clock::now();
}

}  // namespace kelpie::live
