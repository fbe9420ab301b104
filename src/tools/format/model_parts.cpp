// SPDX-License-Identifier: Apache-2.0
#include "format/model_parts.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie::format {
namespace {

using file::Json;
using file::JsonNode;

constexpr double kMostShiftedRows = 1e6;

}  // namespace

Json alignment_json(const Alignment& alignment) {
  return alignment.none() ? Json(nullptr)
                          : Json{{"shift_s", alignment.lag_s},
                                 {"rows", alignment.rows},
                                 {"commands", alignment.commands}};
}

Alignment read_alignment(const JsonNode& node, const std::vector<std::string>& inputs) {
  Alignment alignment;
  if (node.json().is_null()) {
    return alignment;
  }
  alignment.lag_s = node["shift_s"].number();
  const double rows = node["rows"].number();
  node["rows"].require(rows == std::trunc(rows) && std::abs(rows) <= kMostShiftedRows,
                       "has to be a whole number of rows");
  node["shift_s"].require(
      std::abs(alignment.lag_s) <= Alignment::kMostS && alignment.lag_s * rows > 0.0,
      "has to be seconds with the sign of 'rows', neither of them 0");
  alignment.rows = static_cast<int>(rows);
  alignment.commands = node["commands"].names(inputs.size());
  node["commands"].require(
      std::ranges::all_of(
          alignment.commands,
          [&](const std::string& name) { return std::ranges::find(inputs, name) != inputs.end(); }),
      "has to hold inputs only");
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
