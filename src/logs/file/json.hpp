// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace kelpie::file {

/// JSON with keys in the order of insertion.
using Json = nlohmann::ordered_json;

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

/// Parses JSON. Throws InputError on malformed text, and on a number out of a double's range.
Json parse_json(const std::string& text, const std::string& source);

/// A value of a JSON file, with the path for messages. Throws InputError naming file and path on an
/// unsuitable value. Requires the document to be alive.
class JsonNode {
 public:
  JsonNode(const Json& json, std::string source, std::string path)
      : json_(&json), source_(std::move(source)), path_(std::move(path)) {}

  JsonNode operator[](const std::string& key) const;
  const Json& json() const { return *json_; }

  std::string text() const;
  double number() const;  ///< within ±1e100, so that products stay finite
  double positive() const;
  std::vector<JsonNode> items() const;
  std::vector<double> numbers(std::size_t size) const;
  /// A list of 1 to `most` texts.
  std::vector<std::string> names(std::size_t most) const;

  /// The file's first two keys.
  void require_format(const std::string& format, int version) const;
  void require(bool good, const std::string& otherwise) const;

 private:
  const Json* json_;
  std::string source_;
  std::string path_;
};

}  // namespace kelpie::file
