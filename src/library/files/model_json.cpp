// SPDX-License-Identifier: Apache-2.0
#include "files/model_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "kelpie/core/error.hpp"
#include "kelpie/model/open_loop.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/snapshot.hpp"
#include "model/steady_part.hpp"
#include "motion/states.hpp"

namespace kelpie {
namespace {

constexpr int kWithoutCaution = 5;   // members' disagreement did not count
constexpr int kWithoutAttitude = 4;  // `terms = auto` was `quadratic`
constexpr int kOldVersion = 3;       // one learner per axis; `terms = auto` went by names
constexpr std::size_t kMostAxes = 64;
constexpr double kMostShiftedRows = 1e6;

void read_shift(const JsonNode& node, Alignment& alignment) {
  alignment.lag_s = node["shift_s"].number();
  const double rows = node["rows"].number();
  node["rows"].require(rows == std::trunc(rows) && std::abs(rows) <= kMostShiftedRows,
                       "has to be a whole number of rows");
  const bool nothing = alignment.lag_s == 0.0 && rows == 0.0 &&
                       (!alignment.actuators.empty() || !alignment.water.none());
  node["shift_s"].require(
      nothing || (std::abs(alignment.lag_s) <= Alignment::kMostS && alignment.lag_s * rows > 0.0),
      "has to be seconds with the sign of 'rows', neither of them 0 unless there are actuators or "
      "a current");
  alignment.rows = static_cast<int>(rows);
}

// Velocities of the current, two per time.
std::vector<std::array<double, 2>> read_velocities(const JsonNode& node) {
  std::vector<std::array<double, 2>> velocities;
  for (const JsonNode& entry : node.items()) {
    const std::vector<double> both = entry.numbers(2);
    velocities.push_back({both[0], both[1]});
  }
  return velocities;
}

Current read_current(const JsonNode& node, const std::vector<std::string>& inputs,
                     std::size_t targets) {
  Current current;
  if (node.json().is_null()) {
    return current;
  }
  current.heading = node["heading"].text();
  current.unit = node["unit_rad"].number();
  for (const auto& [key, name] : {std::pair{"surge", &current.surge},
                                  {"sway", &current.sway},
                                  {"yaw_rate", &current.yaw_rate}}) {
    *name = node[key].text();
    node[key].require(std::ranges::find(inputs, *name) != inputs.end(), "has to be an input");
  }
  const std::vector<double> places = node["targets"].numbers(2);
  for (std::size_t i = 0; i < places.size(); ++i) {
    node["targets"].require(places[i] >= 0.0 && places[i] < static_cast<double>(targets) &&
                                places[i] == std::trunc(places[i]),
                            "has to hold places of targets, from 0");
    current.targets[i] = static_cast<std::size_t>(places[i]);
  }
  for (const JsonNode& time : node["times_s"].items()) {
    current.times_s.push_back(time.number());
  }
  current.velocity = read_velocities(node["velocity_m_s"]);
  node["times_s"].require(!current.none(), "has to hold a time");
  try {
    current.validate();
  } catch (const InputError& error) {
    node.require(false, error.what());
  }
  return current;
}

Actuator read_actuator(const JsonNode& node) {
  Actuator actuator;
  for (const Actuator::Field& field : Actuator::fields()) {
    actuator.*field.number = node[std::string(field.name)].number();
  }
  try {
    actuator.validate();
  } catch (const InputError& error) {
    node.require(false, error.what());
  }
  return actuator;
}

// Commands without an entry act at once.
std::vector<Actuator> read_actuators(const JsonNode& node,
                                     const std::vector<std::string>& commands) {
  const std::vector<JsonNode> entries = node.items();
  std::vector<Actuator> actuators(entries.empty() ? 0 : commands.size());
  std::vector<std::string> known;
  for (const JsonNode& entry : entries) {
    const std::string command = entry["command"].text();
    const auto found = std::ranges::find(commands, command);
    entry["command"].require(found != commands.end(), "has to be among 'commands'");
    entry["command"].require(std::ranges::find(known, command) == known.end(),
                             "has an actuator already");
    known.push_back(command);
    actuators[static_cast<std::size_t>(found - commands.begin())] = read_actuator(entry);
  }
  return actuators;
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

// Files of older versions lack it.
bool has(const JsonNode& node, const char* key) {
  return node.json().contains(key) && !node.json()[key].is_null();
}

ValueRange read_range(const JsonNode& node) {
  if (node.json().is_null()) {
    return {};
  }
  const std::vector<double> ends = node.numbers(2);
  node.require(ends[0] <= ends[1], "has to go up");
  return {ends[0], ends[1]};
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
  const ValueRange bounds = read_range(node["bounds"]);
  mix.limits = {bounds.low, bounds.high};
  if (has(node, "caution")) {
    mix.limits.caution = node["caution"].number();
    node["caution"].require(mix.limits.caution >= 0.0, "has to be 0 or more");
  }
  if (has(node, "term_ranges") && !node["term_ranges"].json().empty()) {
    for (const JsonNode& range : node["term_ranges"].items()) {
      mix.term_ranges.push_back(read_range(range));
    }
    node["term_ranges"].require(mix.term_ranges.size() == terms, "needs a range per physics term");
  }
  if (has(node, "nominal") && !node["nominal"].json().empty()) {
    mix.nominal = node["nominal"].numbers(terms);
  }
  return mix;
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

SteadyModel read_steady(const JsonNode& node, std::size_t state, std::size_t terms,
                        std::size_t inputs) {
  SteadyModel steady;
  steady.state = state;
  steady.weights = node["weights"].numbers(terms + 1);
  steady.error = node["error"].number();
  steady.error_time_s = node["error_time_s"].number();
  steady.noise = node["noise"].number();
  steady.share = node["share"].number();
  node["share"].require(steady.share >= 0.0 && steady.share <= 1.0, "has to be from 0 to 1");
  std::ranges::copy(node["off"].numbers(steady.off.size()), steady.off.begin());
  std::ranges::copy(node["kept"].numbers(steady.kept.size()), steady.kept.begin());
  for (const JsonNode& range : node["seen"].items()) {
    const std::vector<double> ends = range.numbers(2);
    range.require(ends[0] <= ends[1], "has to go up");
    steady.seen.push_back({ends[0], ends[1]});
  }
  node["seen"].require(steady.seen.size() == inputs, "needs one range per input");
  return steady;
}

// Of a version without practice, or one that took angles for commands: to be learned again.
bool is_older(const Json& steady, std::size_t terms, std::size_t angles_as_commands) {
  return !steady.contains("share") || (terms != angles_as_commands && steady.contains("weights") &&
                                       steady["weights"].size() == angles_as_commands + 1);
}

// The steady parts of every axis, where the settings name velocities among the inputs.
void read_steady_parts(const std::vector<JsonNode>& axes, TrainedModel& model) {
  const std::vector<std::size_t> states =
      find_states(model.settings.shared.states, model.input_names, axes.size());
  const Attitude attitude = attitude_for(model.settings.shared.terms, model.input_names);
  const std::size_t terms = TermSet::open_loop(model.input_names, states, attitude).size();
  const std::size_t angles_as_commands = TermSet::open_loop(model.input_names, states).size();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!axes[i].json().contains("steady")) {
      continue;  // a version without rollouts
    }
    const JsonNode node = axes[i]["steady"];
    if (!node.json().is_null() && !is_older(node.json(), terms, angles_as_commands)) {
      node.require(!states.empty() && terms > 0,
                   "is given, but the setting 'states' names no velocities");
      model.axes[i].steady = read_steady(node, states[i], terms, model.input_names.size());
    }
  }
}

}  // namespace

Alignment read_alignment(const JsonNode& node, const std::vector<std::string>& inputs,
                         std::size_t targets) {
  Alignment alignment;
  if (node.json().is_null()) {
    return alignment;
  }
  if (node.json().contains("current")) {  // older files know of no current
    alignment.water = read_current(node["current"], inputs, targets);
  }
  if (alignment.water.none() || !node["commands"].items().empty()) {
    alignment.commands = node["commands"].names(inputs.size());
  }
  node["commands"].require(
      std::ranges::all_of(
          alignment.commands,
          [&](const std::string& name) { return std::ranges::find(inputs, name) != inputs.end(); }),
      "has to hold inputs only");
  if (node.json().contains("actuators")) {  // older files hold shifts only
    alignment.actuators = read_actuators(node["actuators"], alignment.commands);
  }
  read_shift(node, alignment);
  return alignment;
}

ModelSettings read_settings(const JsonNode& node, std::size_t axes) {
  ModelSettings settings = ModelSettings::from_preset("default", axes);
  node.require(node.json().is_object(), "is not an object");
  for (const auto& [name, value] : node.json().items()) {
    const std::string text = node[name].text();
    if (name == "preset") {
      settings.preset = text;
    } else if (!removed_setting(name)) {  // a removed one: the kernel of each axis tells
      settings.assign(name, present_value(name, text));
    }
  }
  settings.validate();
  return settings;
}

TrainedModel trained_model(const Json& document, const std::string& source) {
  const JsonNode root(document, source, "");
  const bool old = root["version"].json() == kOldVersion;
  const bool without_attitude = root["version"].json() == kWithoutAttitude;
  const Json& version = root["version"].json();
  const bool known = old || without_attitude || version == kWithoutCaution;
  root.require_format(kModelFormat, known ? version.get<int>() : kModelVersion);
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
  if (root.json().contains("alignment")) {
    model.alignment = read_alignment(root["alignment"], model.input_names, axes.size());
  }
  return model;
}

TrainedModel read_trained_model(std::string_view text, const std::string& source) {
  return trained_model(parse_json(text, source), source);
}

}  // namespace kelpie
