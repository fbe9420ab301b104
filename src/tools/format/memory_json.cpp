// SPDX-License-Identifier: Apache-2.0
#include "format/memory_json.hpp"

#include <algorithm>
#include <cstdint>
#include <set>

#include "core/text.hpp"
#include "file/content.hpp"
#include "file/json.hpp"
#include "file/tuning.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "kelpie/motion/term_set.hpp"

namespace kelpie::format {
namespace {

using file::Json;
using file::JsonNode;

constexpr const char* kMemoryFormat = "kelpie-memory";
constexpr int kSamplesVersion = 1, kMemoryVersion = 2;
constexpr double kMostCount = 9e15;  // a double counts up to there

Json model_object(const StoredPastModel& model) {
  return {{"number", model.info.number},
          {"from_s", model.info.from_s},
          {"until_s", model.info.until_s},
          {"samples", model.info.samples},
          {"recalls", model.info.recalls},
          {"usual_error", model.info.usual_error},
          {"rows_per_sample", model.rows_per_sample},
          {"sums", model.sums}};
}

template <typename Count>
Count whole(const JsonNode& node, double least) {
  const double value = node.number();
  node.require(value >= least && value <= kMostCount && value == std::floor(value),
               "has to be a whole number >= " + std::to_string(static_cast<int>(least)));
  return static_cast<Count>(value);
}

// `terms`: with the constant.
StoredPastModel read_past(const JsonNode& node, std::size_t terms) {
  StoredPastModel model;
  model.info = {.number = whole<std::int64_t>(node["number"], 1),
                .from_s = node["from_s"].number(),
                .until_s = node["until_s"].number(),
                .samples = whole<std::int64_t>(node["samples"], 0),
                .recalls = static_cast<int>(
                    std::min(whole<std::int64_t>(node["recalls"], 0), std::int64_t{1'000'000'000})),
                .earlier = 0,
                .usual_error = node["usual_error"].positive()};
  model.info.earlier = model.info.samples;
  model.rows_per_sample = node["rows_per_sample"].positive();
  model.sums = node["sums"].numbers(4 + terms + terms * (terms + 1) / 2);
  node["sums"].require(model.sums[1] > 0.0 && model.sums[2] > 0.0, "are of no samples");
  return model;
}

AxisMemory read_axis(const JsonNode& node, std::size_t terms) {
  AxisMemory axis{.target = node["target"].text(), .models = {}};
  std::set<std::int64_t> numbers;
  for (const JsonNode& model : node["models"].items()) {
    axis.models.push_back(read_past(model, terms));
    model["number"].require(numbers.insert(axis.models.back().info.number).second,
                            "is that of two models");
  }
  return axis;
}

// The same inputs and terms, and the same units wherever both know one.
void require_same_vehicle(const PastModelsFile& memory, const PastModelsFile& log,
                          const std::string& source) {
  if (memory.inputs != log.inputs) {
    throw InputError({.file = source, .line = 0, .field = "inputs"},
                     "are '" + join_text(memory.inputs, ", ") + "' there, '" +
                         join_text(log.inputs, ", ") +
                         "' in the log: not the same vehicle's memory");
  }
  if (memory.terms != log.terms) {
    throw InputError({.file = source, .line = 0, .field = "terms"},
                     "are '" + join_text(memory.terms, "; ") + "' there, '" +
                         join_text(log.terms, "; ") + "' in the run: give the same terms");
  }
  for (const auto& [column, unit] : memory.units) {
    const auto here = log.units.find(column);
    if (here != log.units.end() && here->second != unit) {
      throw InputError({.file = source, .line = 0, .field = "units." + column},
                       "is '" + unit + "' there, '" + here->second +
                           "' in the log: not the same vehicle's memory");
    }
  }
}

// Which of the log's targets it is.
std::size_t place_of(const std::string& target, const log::Dataset& data,
                     const std::string& source) {
  const auto known = std::ranges::find(data.target_names, target);
  if (known == data.target_names.end()) {
    throw InputError({.file = source, .line = 0, .field = "axes"},
                     unknown_name(target, "target", data.target_names));
  }
  return static_cast<std::size_t>(known - data.target_names.begin());
}

PastModelsFile empty_memory(const log::Dataset& data, const ModelSettings& settings) {
  PastModelsFile memory{
      .inputs = data.input_names,
      .units = {},
      .terms =
          TermSet::from(settings.shared.terms, data.input_names, data.target_names.size()).texts(),
      .axes = {}};
  memory.terms.insert(memory.terms.begin(), "1");
  for (const auto& [column, unit] : data.units) {
    memory.units[column] = unit.text();
  }
  return memory;
}

void add_model(std::vector<StoredPastModel>& models, const StoredPastModel& model) {
  const auto number = [](const StoredPastModel& each) { return each.info.number; };
  const auto here = std::ranges::find(models, model.info.number, number);
  const bool known = model.info.earlier > 0;
  if (known && model.info.samples == model.info.earlier) {
    return;  // only others have had a part in it
  }
  if (here == models.end()) {
    models.push_back(model);
  } else if (!known) {
    models.push_back(model);
    models.back().info.number = std::ranges::max(models, {}, number).info.number + 1;
  } else if (here->info.samples < model.info.samples) {
    *here = model;
  }
}

}  // namespace

PastModelsFile PastModelsFile::of(const DynamicsModel& model, const log::Dataset& data,
                                  const ModelSettings& settings) {
  PastModelsFile memory = empty_memory(data, settings);
  for (std::size_t axis = 0; axis < model.axes(); ++axis) {
    memory.axes.push_back({data.target_names[axis], model.past_models(axis)});
  }
  return memory;
}

std::size_t PastModelsFile::size() const {
  std::size_t count = 0;
  for (const AxisMemory& axis : axes) {
    count += axis.models.size();
  }
  return count;
}

void PastModelsFile::give_to(DynamicsModel& model, const log::Dataset& data,
                             const ModelSettings& settings, const std::string& source) const {
  require_same_vehicle(*this, empty_memory(data, settings), source);
  for (const AxisMemory& axis : axes) {
    const std::size_t most = settings.axes[place_of(axis.target, data, source)].past_models();
    if (axis.models.size() > most) {
      throw InputError({.file = source, .line = 0, .field = axis.target},
                       "holds " + std::to_string(axis.models.size()) +
                           " models; the settings keep " + std::to_string(most) +
                           ": raise `memory`, or let go of some with `kelpie memory forget`");
    }
  }
  for (const AxisMemory& axis : axes) {
    model.set_past_models(place_of(axis.target, data, source), axis.models);
  }
}

void PastModelsFile::add(const PastModelsFile& run, const ModelSettings& settings,
                         const std::string& source) {
  require_same_vehicle(*this, run, source);
  units.insert(run.units.begin(), run.units.end());
  for (std::size_t i = 0; i < run.axes.size(); ++i) {
    auto axis = std::ranges::find(axes, run.axes[i].target, &AxisMemory::target);
    if (axis == axes.end()) {
      axis = axes.insert(axes.end(), {.target = run.axes[i].target, .models = {}});
    }
    for (const StoredPastModel& model : run.axes[i].models) {
      add_model(axis->models, model);
    }
    while (axis->models.size() > settings.axes[i].past_models()) {
      axis->models.erase(std::ranges::min_element(
          axis->models, {}, [](const StoredPastModel& m) { return m.info.usefulness(); }));
    }
  }
}

std::string memory_json(const PastModelsFile& memory) {
  const auto axis_json = [](const AxisMemory& axis) {
    return Json{{"target", axis.target}, {"models", file::list(axis.models, model_object)}};
  };
  return file::json_text({{"format", kMemoryFormat},
                          {"version", kMemoryVersion},
                          {"inputs", memory.inputs},
                          {"units", memory.units},
                          {"axes", file::list(memory.axes, axis_json)},
                          {"terms", memory.terms}},
                         -1);
}

PastModelsFile parse_memory_json(const std::string& text, const std::string& source) {
  const Json json = file::parse_json(text, source);
  const JsonNode root(json, source, "");
  root["version"].require(
      root["version"].number() != kSamplesVersion,
      "1 holds the samples of past models, as kelpie 1.x wrote them; kelpie 2.0.0 keeps sums "
      "(CHANGELOG.md): give the name of a new file");
  root.require_format(kMemoryFormat, kMemoryVersion);
  PastModelsFile memory;
  memory.terms = root["terms"].names(kMostTerms + 1);
  memory.inputs = root["inputs"].names(kMostInputs);
  root["units"].require(root["units"].json().is_object(), "is not an object");
  for (const auto& [column, unit] : root["units"].json().items()) {
    memory.units[column] = root["units"][column].text();
  }
  std::set<std::string> targets;
  for (const JsonNode& axis : root["axes"].items()) {
    memory.axes.push_back(read_axis(axis, memory.terms.size()));
    axis["target"].require(targets.insert(memory.axes.back().target).second, "is that of two axes");
  }
  return memory;
}

PastModelsFile read_memory(const std::filesystem::path& file) {
  return parse_memory_json(file::read_content(file, "a memory as `kelpie learn --memory` writes it",
                                              file::kTuning.document_bytes),
                           file.string());
}

std::string AxisMemory::name_of(const StoredPastModel& model) const {
  return target + ":" + std::to_string(model.info.number);
}

StoredPastModel& PastModelsFile::find(std::string_view name, const std::string& source) {
  std::vector<std::string> names;
  for (AxisMemory& axis : axes) {
    for (StoredPastModel& model : axis.models) {
      names.push_back(axis.name_of(model));
      if (names.back() == name) {
        return model;
      }
    }
  }
  throw InputError({.file = source, .line = 0, .field = std::string(name)},
                   names.empty() ? "isn't there: the memory holds no models"
                                 : "isn't there" + did_you_mean(name, names) + "; there are " +
                                       join_text(names, ", "));
}

void PastModelsFile::forget(std::string_view name, const std::string& source) {
  const StoredPastModel* const model = &find(name, source);
  for (AxisMemory& axis : axes) {
    std::erase_if(axis.models, [model](const StoredPastModel& each) { return &each == model; });
  }
}

}  // namespace kelpie::format
