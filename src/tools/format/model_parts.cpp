// SPDX-License-Identifier: Apache-2.0
#include "format/model_parts.hpp"

#include <algorithm>
#include <cmath>

#include "kelpie/core/error.hpp"

namespace kelpie::format {
namespace {

using file::Json;
using file::JsonNode;

constexpr double kMostShiftedRows = 1e6;

void read_shift(const JsonNode& node, Alignment& alignment) {
  alignment.lag_s = node["shift_s"].number();
  const double rows = node["rows"].number();
  node["rows"].require(rows == std::trunc(rows) && std::abs(rows) <= kMostShiftedRows,
                       "has to be a whole number of rows");
  const bool nothing = alignment.lag_s == 0.0 && rows == 0.0 && !alignment.actuators.empty();
  node["shift_s"].require(
      nothing || (std::abs(alignment.lag_s) <= Alignment::kMostS && alignment.lag_s * rows > 0.0),
      "has to be seconds with the sign of 'rows', neither of them 0 unless there are actuators");
  alignment.rows = static_cast<int>(rows);
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

}  // namespace

Json actuators_json(const Alignment& alignment) {
  Json list = Json::array();
  for (std::size_t k = 0; k < alignment.actuators.size(); ++k) {
    Json entry{{"command", alignment.commands[k]}};
    for (const Actuator::Field& field : Actuator::fields()) {
      entry[std::string(field.name)] = alignment.actuators[k].*field.number;
    }
    list.push_back(entry);
  }
  return list;
}

Json alignment_json(const Alignment& alignment) {
  return alignment.none() ? Json(nullptr)
                          : Json{{"shift_s", alignment.lag_s},
                                 {"rows", alignment.rows},
                                 {"commands", alignment.commands},
                                 {"actuators", actuators_json(alignment)}};
}

Alignment read_alignment(const JsonNode& node, const std::vector<std::string>& inputs) {
  Alignment alignment;
  if (node.json().is_null()) {
    return alignment;
  }
  alignment.commands = node["commands"].names(inputs.size());
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
      settings.assign(name, text);
    }
  }
  settings.validate();
  return settings;
}

}  // namespace kelpie::format
