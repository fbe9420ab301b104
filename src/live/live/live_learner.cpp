// SPDX-License-Identifier: Apache-2.0
#include "live/live_learner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/seconds.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "format/model_json.hpp"
#include "kelpie/model/trained_model.hpp"
#include "live/alignment.hpp"
#include "live/health_table.hpp"
#include "live/tuning.hpp"
#include "study/alignment.hpp"

namespace kelpie::live {
namespace {

std::optional<ParameterCountdown> countdown_of(const Configuration& configuration) {
  return configuration.live.parameters
             ? std::optional<ParameterCountdown>(std::in_place, configuration,
                                                 *configuration.live.parameters)
             : std::nullopt;
}

}  // namespace

LiveLearner::LiveLearner(const Configuration& configuration, std::filesystem::path folder,
                         const std::optional<log::Reach>& recording, std::optional<SavedRun> saved,
                         Output& output)
    : configuration_(configuration),
      folder_(std::move(folder)),
      output_(output),
      block_(configuration.live.block.empty()
                 ? nullptr
                 : std::make_unique<file::SharedFile>(configuration.live.block)),
      nominal_(nominal_of(configuration)),
      model_(std::make_shared<SharedModel>(model_to_begin_with(configuration, nominal_, saved))),
      alignment_(configuration.plan.inputs, configuration.plan.targets.size(),
                 configuration.plan.rate_hz, configuration.settings.shared.states,
                 rows_to_keep(configuration, recording),
                 study::known_actuators(configuration.log.roles.actuators)),
      progress_(saved ? saved->progress : Progress{}),
      check_(configuration.plan, configuration.settings.shared.states),
      changes_(configuration.plan, model_->model().ready()),
      authority_(configuration),
      parameters_(countdown_of(configuration)),
      score_(configuration.plan),
      predictions_(configuration.plan.targets.size()),
      decisions_(configuration.plan.targets.size()),
      checkpoint_s_(configuration.live.checkpoint_s) {
  const bool is_same_recording = saved && recording && progress_.recording == *recording;
  known_rows_ = is_same_recording ? progress_.rows : 0;
  progress_.rows = 0;
  progress_.recording = recording.value_or(log::Reach{});
  begin_alignment(is_same_recording && !progress_.is_paused, saved);
  if (progress_.is_paused) {
    output_.event("learning is frozen, as it was before, until it is resumed");
  }
  refresh_health();
}

void LiveLearner::begin_alignment(bool finds_it_anew, const std::optional<SavedRun>& saved) {
  const std::string& wish = configuration_.live.align;
  double seconds = 0.0;
  finds_alignment_ = wish == "auto";
  if (saved && finds_alignment_ && !finds_it_anew) {
    alignment_.adopt({.alignment = saved->alignment, .gain = 0.0, .why = {}});
  } else if (parse_number(wish, seconds) || !configuration_.log.roles.actuators.empty()) {
    alignment_.adopt({.alignment = alignment_of(configuration_, seconds), .gain = 0.0, .why = {}});
  }
  publish_alignment();
  serve_block();
}

void LiveLearner::process(const Row& row) {
  if (row.request) {
    execute(*row.request);
    return;
  }
  if (row.wants_model) {
    give_model();
  }
  ++progress_.rows;
  if (row.origin_ns != progress_.origin_ns) {
    alignment_.finish(to_learning());  // those that wait count from the other one
    progress_.origin_ns = row.origin_ns;
  }
  progress_.received_ns = row.received_ns;
  align(row);
  last_t_s_ = row.t;
  const auto now = std::chrono::steady_clock::now();
  score_.add_delay(now - row.came);
  if (!std::exchange(has_saved_, true)) {
    saved_t_s_ = row.t;
  }
  if (!is_known() && (is_save_due_ || !(std::abs(row.t - saved_t_s_) < checkpoint_s_))) {
    save();
  }
  rows_taken_.fetch_add(1);
  if (now - refreshed_ > kTuning.between_reports) {
    refresh_health();
  }
}

void LiveLearner::align(const Row& row) {
  if (row.is_stuck != is_stuck_) {
    is_stuck_ = row.is_stuck;
    output_.event(fmt::format("at {:.1f} s: {}", row.t,
                              is_stuck_ ? "a velocity is stuck; rows aren't learned"
                                        : "velocities change again; rows are learned"));
  }
  if (progress_.is_paused) {
    rows_paused_ += is_known() ? 0 : 1;
    if (!row.is_stuck) {
      alignment_.pass(row.x, row.y, row.t, to_learning());
    }
  } else if (row.is_stuck) {
    ++rows_stuck_;
  } else {
    doubt(check_.take(row));
    alignment_.push(row.x, row.y, row.t, to_learning());
    if (finds_alignment_ && alignment_.is_due() && !has_changed()) {
      update_alignment(false);
    }
  }
}

// Rows of two vehicles tell actuators of neither, and a model that begins anew forgets what
// changed.
bool LiveLearner::has_changed() const {
  const Diagnosis* const diagnosis = model_->model().diagnosis();
  const Alignment& present = alignment_.alignment();
  return (present.rows != 0 || !present.actuators.empty()) && diagnosis != nullptr &&
         std::ranges::find(diagnosis->findings(), FindingState::named, &Finding::state) !=
             diagnosis->findings().end();
}

// A vehicle under way keeps its model: the operator decides. The doubt lasts as long as the model.
void LiveLearner::doubt(const std::vector<log::Mistake>& mistakes) {
  if (mistakes.empty() || !progress_.doubt.empty()) {
    return;
  }
  std::vector<std::string> texts;
  std::ranges::transform(mistakes, std::back_inserter(texts), log::mistake_text);
  progress_.doubt = join_text(texts, "; ");
  output_.event(
      fmt::format("at {:.1f} s: {}{}: {}", last_t_s_, kWarning, kModelDoubtful, progress_.doubt));
}

void LiveLearner::execute(Request request) {
  switch (request) {
    case Request::save:
      save_all();
      break;
    case Request::freeze:
    case Request::resume:
      if (progress_.is_paused != (request == Request::freeze)) {
        alignment_.finish(to_learning());  // those that wait came before it
      }
      progress_.is_paused = request == Request::freeze;
      save();  // so that it holds after a kill, too
      output_.event(progress_.is_paused ? "learning is frozen: the model stays as it is"
                                        : "learning goes on");
      break;
    case Request::reset:
      reset();
      break;
  }
  refresh_health();
}

void LiveLearner::save_all() {
  save();
  try {
    const bool is_written = write_model();
    if (health().checkpoint_error.empty()) {
      output_.event(fmt::format("saved, after {} samples{}", progress_.learned,
                                is_written ? "" : "; no model is ready yet"));
    }
  } catch (const std::exception& failure) {
    output_.event(std::string("no model could be written, learning goes on: ") + failure.what());
  }
}

void LiveLearner::reset() {
  known_rows_ = 0;
  progress_.doubt.clear();
  begin_anew();
  std::error_code error;
  std::filesystem::remove(folder_ / "model.json", error);  // is of the old model
  save();
  output_.event("the model begins anew");
}

void LiveLearner::begin_anew() {
  auto next =
      std::make_shared<SharedModel>(model_to_begin_with(configuration_, nominal_, std::nullopt));
  {
    const std::lock_guard lock(mutex_);
    model_.swap(next);
  }
  serve_block();
  progress_.clock = {};
  progress_.learned = 0;
  changes_ = ChangeReporter(configuration_.plan, false);
  authority_ = AuthorityReporter(configuration_);
  parameters_ = countdown_of(configuration_);
  score_ = PredictionScore(configuration_.plan);
}

void LiveLearner::learn_aligned(std::span<const double> x, std::span<const double> y, double t) {
  if (is_known()) {
    return;
  }
  const SharedModel& shared = *model_;
  const bool is_learned = !progress_.is_paused;
  if (is_learned) {
    update(x, y, t);
    changes_.report(shared.model(), progress_.learned, t, output_);
  }
  output_.learned({.stamp_ns = progress_.origin_ns + nanoseconds(t),
                   .t = t,
                   .x = x,
                   .y = y,
                   .decisions = is_learned ? shared.model().decisions() : predict(shared, x),
                   .is_learned = is_learned});
}

std::span<const Decision> LiveLearner::predict(const SharedModel& model,
                                               std::span<const double> x) {
  const bool had_model = model.predict(x, predictions_) > 0;
  for (std::size_t i = 0; i < decisions_.size(); ++i) {
    decisions_[i] = Decision{.prediction = predictions_[i], .had_model = had_model};
  }
  return decisions_;
}

void LiveLearner::update(std::span<const double> x, std::span<const double> y, double t) {
  SharedModel& shared = *model_;
  shared.update(x, y, progress_.clock.at(t));
  authority_.observe(x);
  if (parameters_) {
    const bool changed = std::ranges::any_of(shared.model().decisions(), &Decision::changed);
    parameters_->update(x, t, changed, output_);
  }
  ++progress_.learned;
  score_.score(x, y, t, shared.model().decisions());
}

void LiveLearner::update_alignment(bool afresh) {
  const AlignmentResult found = alignment_.search(afresh);
  if (!alignment_.adopt(found)) {
    return;
  }
  publish_alignment();
  if (is_known()) {
    serve_block();
    return;
  }
  output_.event(alignment_.alignment().text() + ": " + found.why +
                "; the model begins anew with the rows kept");
  begin_anew();
  alignment_.replay([&](auto x, auto y, double t) { update(x, y, t); });
}

void LiveLearner::finish() {
  if (progress_.is_paused) {
    return;
  }
  doubt(check_.finish());
  known_rows_ = 0;  // those that wait haven't been learned, whatever the checkpoint has
  if (finds_alignment_ && progress_.recording != log::Reach{}) {
    update_alignment(true);
  }
  alignment_.finish(to_learning());
  model_->learn_held_back();
}

void LiveLearner::save() {
  if (known_rows_ > 0 && is_known()) {
    is_save_due_ = true;  // the one on the disk is further
    return;
  }
  is_save_due_ = false;
  const bool was_well = health().checkpoint_error.empty();
  std::string error;
  try {
    write_checkpoint(folder_, configuration_,
                     {.progress = progress_,
                      .alignment = alignment_.alignment(),
                      .model = model_->model().save(),
                      .file = {},
                      .note = {}});
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  saved_t_s_ = last_t_s_;
  {
    const std::lock_guard lock(mutex_);
    health_.checkpoint_error = error;
    if (error.empty()) {
      ++health_.checkpoints;
      health_.checkpoint_t_s = last_t_s_;
      health_.last_t_s =
          last_t_s_;  // so that the checkpoint has no negative age until the next report
    } else {
      ++health_.checkpoints_failed;
    }
  }
  if (error.empty() != was_well) {
    output_.event(error.empty() ? "checkpoints are written again"
                                : "no checkpoint can be written, learning goes on: " + error);
  }
}

bool LiveLearner::write_model() const {
  const DynamicsModel& model = model_->model();
  if (!model.ready()) {
    return false;
  }
  TrainedModel trained = model.trained();
  trained.alignment = alignment_.alignment();
  file::write_file_whole(
      folder_ / "model.json",
      format::model_json(trained, {.units = format::unit_texts(configuration_.units()),
                                   .doubt = progress_.doubt}));
  return true;
}

void LiveLearner::publish_alignment() {
  auto next = std::make_shared<const Alignment>(alignment_.alignment());
  const std::lock_guard lock(mutex_);
  published_.swap(next);
}

// The block keeps the last model until the next one is ready.
void LiveLearner::serve_block() {
  if (!block_) {
    return;
  }
  in_file(configuration_.live.block, [&] {
    model_->serve(block_->bytes(), configuration_.plan.inputs, configuration_.plan.targets,
                  alignment_.alignment());
  });
}

void LiveLearner::give_model() {
  auto next = live::reckoning_model(model_->model(), published_);
  {
    const std::lock_guard lock(mutex_);
    reckoning_model_.swap(next);
  }
  models_given_.fetch_add(1);
}

std::shared_ptr<const ReckoningModel> LiveLearner::reckoning_model() const {
  const std::lock_guard lock(mutex_);
  return reckoning_model_;
}

std::shared_ptr<const Alignment> LiveLearner::alignment() const {
  const std::lock_guard lock(mutex_);
  return published_;
}

// libstdc++ 12's atomic<shared_ptr> has a data race (its load() unlocks with relaxed order).
std::shared_ptr<const SharedModel> LiveLearner::model() const {
  const std::lock_guard lock(mutex_);
  return model_;
}

LearnerHealth LiveLearner::health() const {
  const std::lock_guard lock(mutex_);
  return health_;
}

void LiveLearner::refresh_health() {
  LearnerHealth now = health();
  score_.report(model_->model(), now);
  now.rows = progress_.rows;
  now.learned = progress_.learned;
  now.rows_stuck = rows_stuck_;
  now.is_paused = progress_.is_paused;
  now.rows_paused = rows_paused_;
  now.alignment = alignment_.alignment();
  now.vehicle = changes_.vehicle();
  now.doubt = progress_.doubt;
  now.last_t_s = last_t_s_;
  authority_.update(model_->model().diagnosis(), now.alignment, last_t_s_, now, output_);
  if (parameters_) {
    parameters_->report(now);
  }
  refreshed_ = std::chrono::steady_clock::now();
  const std::lock_guard lock(mutex_);
  health_ = std::move(now);
}

}  // namespace kelpie::live
