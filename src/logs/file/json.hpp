// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/json_node.hpp"

namespace kelpie::file {

// Reading is the library's: a model.json is read without these buildings.
using kelpie::Json;
using kelpie::json_or_discarded;
using kelpie::JsonNode;
using kelpie::parse_json;

/// A number; NaN and infinities become null.
inline Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// An array of the results of `function` for the items.
template <typename Items, typename Function>
Json list(const Items& items, Function function) {
  Json array = Json::array();
  for (const auto& item : items) {
    array.push_back(function(item));
  }
  return array;
}

inline Json numbers(const std::vector<double>& values) {
  return list(values, number);
}

/// Null for an empty text.
inline Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

/// An object of pairs of name and value, in order.
template <typename Pairs>
Json object(const Pairs& pairs) {
  Json json = Json::object();
  for (const auto& [name, value] : pairs) {
    json[name] = value;
  }
  return json;
}

/// The content of a file: broken UTF-8 repaired, a newline at the end.
std::string json_text(const Json& document, int indent = 2);
/// A document in a single line, without line end.
std::string one_line(const Json& document);

/// Whether a text is valid UTF-8, as needed in JSON and pages.
bool is_utf8(const std::string& text);

}  // namespace kelpie::file
