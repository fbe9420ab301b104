// SPDX-License-Identifier: Apache-2.0
#include "cli/learn_start.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "format/memory_json.hpp"
#include "format/model_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"
#include "study/training_scales.hpp"

namespace kelpie::cli {
namespace {

std::vector<AxisScaling> saved_scales(const std::string& file, const log::Dataset& data) {
  const TrainedModel model = format::read_model(file);
  std::vector<AxisScaling> scales;
  const std::vector<std::string> targets = model.target_names();
  for (const TrainedModel::Axis& axis : model.axes) {
    scales.push_back(axis.scaling);
  }
  if (model.input_names != data.input_names || targets != data.target_names) {
    throw InputError({.file = file, .line = 0, .field = "--scales"},
                     "is a model of " + join_text(model.input_names, ",") + " → " +
                         join_text(targets, ",") + "; this log is read as " +
                         join_text(data.input_names, ",") + " → " +
                         join_text(data.target_names, ","));
  }
  return scales;
}

// The default --out is where the model of the run before is likely to lie.
void refuse_to_replace_start(const LearnArguments& options) {
  namespace fs = std::filesystem;
  std::error_code none;  // where there is no such folder yet
  for (const char* const name :
       {"model.json", format::kCheckpointName, format::kPreviousCheckpointName}) {
    if (!options.from.empty() && fs::equivalent(options.from, fs::path(options.out) / name, none)) {
      throw InputError({.file = options.from, .line = 0, .field = "--from"},
                       "lies where --out puts the new model; give another folder, as in --out " +
                           options.out + "_next");
    }
  }
}

}  // namespace

void require_one_start(const LearnArguments& options) {
  if (!options.from.empty() && options.scales != "first") {
    throw InputError("--scales", "stands in the model of --from; leave it out");
  }
  if (!options.from.empty() && !options.memory.empty()) {
    throw InputError("--memory",
                     "finds the past model that fits, and --from says which; give one of the two");
  }
  refuse_to_replace_start(options);
}

std::vector<std::string> files_read(const LearnArguments& options) {
  std::vector<std::string> files = options.more;
  files.insert(files.end(), {options.log.source.path, options.config, options.scales, options.from,
                             options.memory});
  return files;
}

std::vector<format::LearnedLog> all_learned(const LearnArguments& options,
                                            const std::vector<format::LearnedLog>& now) {
  if (!options.memory.empty() && std::filesystem::exists(options.memory)) {
    return {};
  }
  std::vector<format::LearnedLog> logs;
  if (!options.from.empty()) {
    if (!format::is_checkpoint(options.from)) {
      logs = format::read_learned_logs(options.from);
    }
    if (logs.empty()) {
      return {};
    }
  }
  logs.insert(logs.end(), now.begin(), now.end());
  const bool holds_out =
      std::ranges::any_of(logs, [](const auto& log) { return !log.held_out.empty(); });
  return holds_out ? logs : std::vector<format::LearnedLog>{};
}

DynamicsModel make_model(const LearnArguments& options, const format::Origin* from,
                         const log::Dataset& data, const study::Split& split,
                         const ModelSettings& settings) {
  if (from != nullptr) {
    return from->model(settings, data.times_s.front());
  }
  // Fails early where the scaling could never be found on line.
  std::vector<AxisScaling> scales = study::training_scales(data, split.training, settings.shared);
  if (options.scales == "first") {
    return {data.input_names, data.target_names, settings};
  }
  if (options.scales != "train") {
    scales = saved_scales(options.scales, data);
  }
  return {data.input_names, data.target_names, settings, scales};
}

void give_memory(const LearnArguments& options, const log::Dataset& data,
                 const ModelSettings& settings, DynamicsModel& model) {
  if (!options.memory.empty() && std::filesystem::exists(options.memory)) {
    format::read_memory(options.memory).give_to(model, data, settings, options.memory);
  }
}

std::string scales_text(const LearnArguments& options, const ModelSettings& settings) {
  if (!options.from.empty()) {
    return "as in " + options.from;
  }
  if (options.scales == "first") {
    return "first " + std::to_string(settings.shared.warmup) + " training samples";
  }
  return options.scales == "train" ? "all training rows (known beforehand)" : options.scales;
}

}  // namespace kelpie::cli
