// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace kelpie::file {

/// Keys stay in the order in which they were written.
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

/// Null for an empty text.
inline Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

/// An object of pairs of name and value, in their order.
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
/// The same in one line, without its end.
std::string one_line(const Json& document);

/// Whether a text is whole UTF-8, as JSON and pages need it.
bool is_utf8(const std::string& text);

/// A file's content; `what` is needed there. Throws InputError when it can't be read.
std::string read_text(const std::filesystem::path& file, const std::string& what);

/// Throws InputError on text that is no JSON, or holds a number out of a double's range.
Json parse_json(const std::string& text, const std::string& source);

/// A key of a JSON file, with the path to it for messages. What doesn't fit is an InputError that
/// names file and path. Requires that the document outlives it.
class JsonNode {
 public:
  JsonNode(const Json& json, std::string source, std::string path)
      : json_(&json), source_(std::move(source)), path_(std::move(path)) {}

  JsonNode operator[](const std::string& key) const;
  const Json& json() const { return *json_; }

  std::string text() const;
  double number() const;  ///< within ±1e100, so that one can calculate with it
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
