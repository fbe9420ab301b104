// SPDX-License-Identifier: Apache-2.0
#include "fleet/worker.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "fleet/outcome.hpp"
#include "fleet/tuning.hpp"
#include "format/settings_file.hpp"
#include "log/read_log.hpp"
#include "study/learn.hpp"

namespace kelpie::fleet {
namespace {

log::Dataset read(const Source& source, const std::string& file,
                  const std::string& held_out_column) {
  log::Roles roles = source.log.roles;
  roles.held_out = held_out_column;
  const bag::ReadMode mode = source.recover ? bag::ReadMode::recover : bag::ReadMode::usual;
  return log::read_log({.path = file, .mode = mode}, source.log, roles).dataset();
}

// The largest of the axes; the number of axes is unknown before the log is read.
double buffer_of(const Source& source, const LearnerConfig& learner) {
  std::string preset = "default";
  std::string buffer;
  const auto look_at = [&](const std::string& name, const std::string& value) {
    preset = name == "preset" ? value : preset;
    buffer = name == "buffer" ? value : buffer;
  };
  for (const auto& [name, value] : source.settings.settings) {
    look_at(name, value.text);
  }
  for (const std::string& setting : learner.set) {
    const auto [name, value] = format::key_and_value(setting);
    look_at(name, value);
  }
  ModelSettings settings = ModelSettings::from_preset(preset, 1);
  if (!buffer.empty()) {
    settings.axes.resize(split_text(buffer, ',').size());
    settings.assign("buffer", buffer);
  }
  return static_cast<double>(
      std::ranges::max(settings.axes, {}, &OnlineSvrSettings::buffer).buffer);
}

// A plan for each row of the study; nothing where `advance` stopped the run.
std::optional<Outcome> learn(const log::Dataset& read, const Source& source,
                             const LearnerConfig& learner, const study::SplitSettings& split,
                             const jobs::Advance& advance) {
  const study::LearnPlan plan = study::plan_learning(
      read, split, format::make_settings(source.settings, learner.set, read.target_names.size()),
      source.align);
  study::require_held_out(plan.split);
  DynamicsModel model = study::make_model(plan);
  const auto rows = static_cast<double>(plan.split.training.size());
  study::StreamOptions options;
  options.keep_going = [&](std::size_t shown) {
    return shown % kTuning.advance_every != 0 || advance(static_cast<double>(shown) / rows);
  };
  const study::StreamResult stream = study::learn(plan, model, options);
  if (stream.interrupted) {
    return std::nullopt;
  }
  return outcome_of(stream, plan.data.times_s.back() - plan.data.times_s.front());
}

}  // namespace

jobs::Job job_of(const Plan& plan, const std::vector<Mission>& missions, const Combination& one) {
  const Mission& mission = missions[one.mission];
  return {.cost = (1.0 + static_cast<double>(mission.bytes)) *
                  (kTuning.free_buffer +
                   buffer_of(plan.sources[mission.source], plan.learners[one.learner])),
          .kind = mission.source * plan.learners.size() + one.learner};
}

std::string Worker::operator()(const Combination& one, const jobs::Advance& advance) {
  const auto start = std::chrono::steady_clock::now();
  try {
    const Mission& mission = missions_[one.mission];
    const Source& source = plan_.sources[mission.source];
    const SplitOptions& wish = plan_.splits[one.split];
    const study::SplitSettings split = study::parse_split(wish.split, wish.seed);
    const auto data = dataset(source, mission.file.string(), split.column);
    std::optional<Outcome> outcome =
        learn(*data, source, plan_.learners[one.learner], split, advance);
    if (!outcome) {
      return {};
    }
    outcome->times.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return file::one_line(outcome_json(*outcome));
  } catch (const std::exception& error) {  // one log of thousands: the study goes on
    return file::one_line({{"error", error.what()}});
  }
}

std::shared_ptr<Worker::Held> Worker::held(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  std::shared_ptr<Held> log = logs_[name].lock();
  if (!log) {
    log = std::make_shared<Held>();
    logs_[name] = log;
  }
  last_[std::this_thread::get_id()] = log;
  std::erase_if(logs_, [](const auto& one) { return one.second.expired(); });
  return log;
}

std::shared_ptr<const log::Dataset> Worker::dataset(const Source& source, const std::string& file,
                                                    const std::string& held_out_column) {
  const std::shared_ptr<Held> log = held(file + "\n" + held_out_column);
  const std::scoped_lock lock(log->reading);
  if (!log->data) {
    log->data = std::make_shared<const log::Dataset>(read(source, file, held_out_column));
  }
  return log->data;
}

}  // namespace kelpie::fleet
