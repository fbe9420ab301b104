// SPDX-License-Identifier: Apache-2.0
#include "format/model_json.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "file/content.hpp"
#include "file/json.hpp"
#include "file/tuning.hpp"
#include "format/model_parts.hpp"
#include "format/steady_json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/motion/unit.hpp"
#include "model/snapshot.hpp"

namespace kelpie::format {
namespace {

using file::Json;
using file::JsonNode;

constexpr const char* kModelFormat = "kelpie-model";
constexpr int kModelVersion = 5;
constexpr int kWithoutAttitude = 4;  // `terms = auto` was `quadratic`
constexpr int kOldVersion = 3;       // one learner per axis; `terms = auto` went by names
constexpr std::size_t kMostAxes = 64;

std::vector<double> numbers(std::span<const double> values) {
  return {values.begin(), values.end()};
}

Json scaling_json(const AxisScaling& scaling) {
  const InputScaling& input = scaling.input;
  Json rows = Json::array();
  for (std::size_t row = 0; row < input.whitening.rows(); ++row) {
    rows.push_back(input.whitening.row(row));
  }
  return {{"input_mean", input.mean},
          {"whitening", rows},
          {"target_mean", scaling.target.mean},
          {"target_scale", scaling.target.scale},
          {"term_scale", scaling.term_scale}};
}

Json kernel_json(const MixedKernel& kernel) {
  return {{"type", "squared_exponential_and_terms"},
          {"gamma", kernel.local().gamma()},
          {"s", kernel.weights().s},
          {"fine", kernel.weights().fine},
          {"lambda", kernel.weights().lambda}};
}

Json rows_json(const SampleStore& samples) {
  Json rows = Json::array();
  std::vector<double> z(samples.dimension());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples.get(i, z);
    rows.push_back(z);
  }
  return rows;
}

Json known_json(const KnownPlaces& known) {
  return {{"bandwidth", known.density.bandwidth()},
          {"sums", numbers(known.density.sums())},
          {"places", rows_json(known.samples)}};
}

Json member_json(const FunctionMix::Member& member) {
  return {{"name", member.name},
          {"share", member.share},
          {"kernel", kernel_json(member.function.kernel())},
          {"bias", member.function.bias()},
          {"term_weights", numbers(member.function.term_weights())},
          {"beta", numbers(member.function.beta())},
          {"support_vectors", rows_json(member.function.support_vectors())}};
}

Json axis_json(const TrainedModel::Axis& axis) {
  const Limits& limits = axis.function.limits;
  return {{"target", axis.name},
          {"scaling", scaling_json(axis.scaling)},
          {"steady", steady_json(axis.steady)},
          {"kkt_gap", axis.kkt_gap},
          {"half_width", file::number(axis.half_width)},
          {"known", axis.known ? known_json(*axis.known) : Json(nullptr)},
          {"bounds", std::isfinite(limits.low) ? Json{limits.low, limits.high} : Json(nullptr)},
          {"members", file::list(axis.function.members, member_json)}};
}

AxisScaling read_scaling(const JsonNode& node, std::size_t inputs, std::size_t terms) {
  AxisScaling scaling;
  scaling.input.mean = node["input_mean"].numbers(inputs);
  scaling.input.whitening = Matrix(inputs, inputs);
  const std::vector<JsonNode> rows = node["whitening"].items();
  node["whitening"].require(rows.size() == inputs, "needs one row per input");
  for (std::size_t row = 0; row < inputs; ++row) {
    const std::vector<double> values = rows[row].numbers(inputs);
    for (std::size_t column = 0; column < inputs; ++column) {
      scaling.input.whitening(row, column) = values[column];
    }
  }
  scaling.target = {node["target_mean"].number(), node["target_scale"].positive()};
  scaling.term_scale = node["term_scale"].numbers(terms);
  for (const double scale : scaling.term_scale) {
    node["term_scale"].require(scale > 0.0, "has to hold numbers > 0");
  }
  return scaling;
}

MixedKernel read_kernel(const JsonNode& node, std::size_t inputs, std::size_t terms) {
  const std::string type = node["type"].text();
  node["type"].require(type == "squared_exponential_and_terms",
                       "'" + type + "' is not known; 'squared_exponential_and_terms' is");
  const KernelWeights weights{node["s"].number(), node["fine"].number(), node["lambda"].number()};
  return {node["gamma"].positive(), weights, inputs, terms};
}

SampleStore read_rows(const JsonNode& node, std::size_t width) {
  const std::vector<JsonNode> rows = node.items();
  SampleStore samples(width, rows.size());
  for (const JsonNode& row : rows) {
    samples.push_back(row.numbers(width));
  }
  return samples;
}

KnownPlaces read_known(const JsonNode& node, std::size_t inputs) {
  SampleStore samples = read_rows(node["places"], inputs);
  KernelDensity density(inputs, samples.size(), node["bandwidth"].positive());
  density.assume(node["sums"].numbers(samples.size()));
  return {std::move(samples), std::move(density)};
}

// In older files support vectors hold their terms, from which follow the terms' weights.
SvrFunction read_function(const JsonNode& node, std::size_t inputs, std::size_t terms, bool old) {
  const SampleStore samples = read_rows(node["support_vectors"], old ? inputs + terms : inputs);
  const std::vector<double> beta = node["beta"].numbers(samples.size());
  SvrFunction function(read_kernel(node["kernel"], inputs, terms), samples.size());
  if (old) {
    function.assign(samples, beta, node["bias"].number());
  } else {
    function.assign(samples, beta, node["term_weights"].numbers(terms), node["bias"].number());
  }
  return function;
}

FunctionMix read_mix(const JsonNode& node, std::size_t inputs, std::size_t terms) {
  FunctionMix mix;
  double total = 0.0;
  for (const JsonNode& member : node["members"].items()) {
    const double share = member["share"].number();
    member["share"].require(share >= 0.0 && share <= 1.0, "has to be from 0 to 1");
    total += share;
    mix.members.push_back(
        {member["name"].text(), share, read_function(member, inputs, terms, false)});
  }
  node["members"].require(std::abs(total - 1.0) < 1e-9, "needs shares that add up to 1");
  if (!node["bounds"].json().is_null()) {
    const std::vector<double> ends = node["bounds"].numbers(2);
    node["bounds"].require(ends[0] <= ends[1], "has to go up");
    mix.limits = {ends[0], ends[1]};
  }
  return mix;
}

// Files of older versions lack it.
bool has(const JsonNode& node, const char* key) {
  return node.json().contains(key) && !node.json()[key].is_null();
}

TrainedModel::Axis read_axis(const JsonNode& node, std::size_t inputs, std::size_t terms,
                             bool old) {
  FunctionMix function =
      old ? FunctionMix{.members = {{"learner", 1.0, read_function(node, inputs, terms, true)}}}
          : read_mix(node, inputs, terms);
  TrainedModel::Axis axis{node["target"].text(),
                          read_scaling(node["scaling"], inputs, terms),
                          std::move(function),
                          node["kkt_gap"].number(),
                          {}};
  if (has(node, "half_width")) {
    axis.half_width = node["half_width"].number();
    node["half_width"].require(axis.half_width >= 0.0, "has to be 0 or more");
  }
  if (has(node, "known")) {
    axis.known = read_known(node["known"], inputs);
  }
  return axis;
}

// What `terms = auto` meant in older files.
std::string old_terms(std::span<const std::string> inputs) {
  constexpr std::string_view kNamed = "uvwpqr";
  const auto other = std::ranges::find_if(inputs, [&](const std::string& name) {
    return name.size() != 1 || kNamed.find(name[0]) == std::string_view::npos;
  });
  const auto named = static_cast<std::size_t>(other - inputs.begin());
  return named == 0 ? "none" : named == 6 ? "6dof" : "fossen:" + std::to_string(named);
}

// A unit that cannot be read is named with its column.
ColumnUnits units_in(const JsonNode& node, const Json& json) {
  node.require(json.is_object(), "has to be an object of columns and units");
  ColumnUnits units;
  for (const auto& [column, unit] : json.items()) {
    units[column] = node[column].text();
    try {
      static_cast<void>(Unit::parse(units[column]));
    } catch (const InputError& error) {
      node[column].require(false, error.what());
    }
  }
  return units;
}

}  // namespace

std::string model_json(const TrainedModel& model, std::span<const LearnedLog> learned,
                       const ColumnUnits& units) {
  Json json{{"format", kModelFormat},
            {"version", kModelVersion},
            {"inputs", model.input_names},
            {"settings", file::object(model.settings.values())},
            {"alignment", alignment_json(model.alignment)},
            {"axes", file::list(model.axes, axis_json)}};
  if (!learned.empty()) {
    json["learned"] = learned_json(learned);
  }
  if (!units.empty()) {
    json["units"] = units;
  }
  return file::json_text(json, 1);
}

TrainedModel parse_model_json(const std::string& text, const std::string& source) {
  const Json json = file::parse_json(text, source);
  const JsonNode root(json, source, "");
  const bool old = root["version"].json() == kOldVersion;
  const bool without_attitude = root["version"].json() == kWithoutAttitude;
  root.require_format(kModelFormat, old                ? kOldVersion
                                    : without_attitude ? kWithoutAttitude
                                                       : kModelVersion);
  TrainedModel model;
  model.input_names = root["inputs"].names(kMostInputs);
  const std::vector<JsonNode> axes = root["axes"].items();
  root["axes"].require(!axes.empty() && axes.size() <= kMostAxes,
                       "needs 1 to " + std::to_string(kMostAxes) + " axes");
  try {
    model.settings = read_settings(root["settings"], axes.size());
    if (old) {
      model.settings.shared.learner = LearnerKind::svr;
    }
    if (old && model.settings.shared.terms == "auto") {
      model.settings.shared.terms = old_terms(model.input_names);
    }
    if (without_attitude && model.settings.shared.terms == TermSet::kAuto) {
      model.settings.shared.terms = "quadratic";
    }
    model.terms = TermSet::from(model.settings.shared.terms, model.input_names, axes.size());
  } catch (const InputError& error) {
    if (!error.place().file.empty()) {
      throw;
    }
    throw InputError({.file = source, .line = 0, .field = "settings"}, error.what());
  }
  for (const JsonNode& axis : axes) {
    model.axes.push_back(read_axis(axis, model.input_names.size(), model.terms.size(), old));
  }
  read_steady_parts(axes, model);
  if (json.contains("alignment")) {
    model.alignment = read_alignment(root["alignment"], model.input_names);
  }
  if (json.contains("learned")) {
    static_cast<void>(read_learned(root["learned"]));  // only so that what is wrong is named
  }
  if (json.contains("units")) {
    static_cast<void>(units_in(root["units"], json["units"]));
  }
  return model;
}

namespace {

std::string content_of(const std::filesystem::path& file) {
  return file::read_content(file, "a model.json as `kelpie learn` writes it",
                            file::kTuning.document_bytes);
}

}  // namespace

ColumnUnits read_units(const std::filesystem::path& file) {
  const Json json = file::parse_json(content_of(file), file.string());
  const JsonNode root(json, file.string(), "");
  return json.contains("units") ? units_in(root["units"], json["units"]) : ColumnUnits{};
}

TrainedModel read_model(const std::filesystem::path& file) {
  return parse_model_json(content_of(file), file.string());
}

}  // namespace kelpie::format
