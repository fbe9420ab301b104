// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie {

/// JSON with keys in the order of insertion.
using Json = nlohmann::ordered_json;

/// Lists and objects within each other; kelpie's own files have some ten.
inline constexpr std::size_t kDeepestJson = 100;
/// Keys of an object; kelpie's own files have some hundred.
inline constexpr std::size_t kMostJsonKeys = 1'000;

/// Parses JSON, by way of `callback` if given. Throws InputError on malformed text, beyond
/// kDeepestJson and kMostJsonKeys, and on a number out of a double's range. No other function
/// parses JSON.
Json parse_json(std::string_view text, const std::string& source,
                const Json::parser_callback_t& callback = nullptr);
/// The same, but a discarded value in place of an InputError.
Json json_or_discarded(std::string_view text);

/// A value of a JSON file, with the path for messages. Throws InputError naming file and path on an
/// unsuitable value. Requires the document to be alive.
class JsonNode {
 public:
  static constexpr double kLargest = 1e100;  ///< a square, a million times, is finite still

  JsonNode(const Json& json, std::string source, std::string path)
      : json_(&json), source_(std::move(source)), path_(std::move(path)) {}

  JsonNode operator[](const std::string& key) const;
  const Json& json() const { return *json_; }

  std::string text() const;
  double number() const;  ///< within ±kLargest
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

}  // namespace kelpie
