// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace kelpie::format {

using Json = nlohmann::ordered_json;

/// NaN and infinities, which JSON doesn't know, as null.
inline Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// An array of what `function` makes of each item.
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

/// As a file: broken UTF-8 repaired, a newline at the end.
inline std::string json_text(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace kelpie::format
