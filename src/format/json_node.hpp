// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "format/json_parts.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::format {

/// A key of a JSON file, with the path to it for messages: what doesn't fit is an InputError that
/// names file and path.
class JsonNode {
 public:
  JsonNode(const Json& json, std::string source, std::string path)
      : json_(&json), source_(std::move(source)), path_(std::move(path)) {}

  JsonNode operator[](const std::string& key) const {
    require(json_->is_object() && json_->contains(key), "has no '" + key + "'");
    return {(*json_)[key], source_, path_.empty() ? key : path_ + "." + key};
  }

  std::vector<JsonNode> items() const {
    require(json_->is_array(), "is not a list");
    std::vector<JsonNode> list;
    for (std::size_t i = 0; i < json_->size(); ++i) {
      list.emplace_back((*json_)[i], source_, path_ + "[" + std::to_string(i) + "]");
    }
    return list;
  }

  /// A list of 1 to `most` texts.
  std::vector<std::string> names(std::size_t most) const {
    std::vector<std::string> texts;
    for (const JsonNode& item : items()) {
      texts.push_back(item.text());
    }
    require(!texts.empty() && texts.size() <= most,
            "needs 1 to " + std::to_string(most) + " names");
    return texts;
  }

  const Json& json() const { return *json_; }

  std::string text() const {
    require(json_->is_string(), "is not a text");
    return json_->get<std::string>();
  }

  double number() const {
    require(json_->is_number(), "is not a number");
    const auto value = json_->get<double>();
    require(std::isfinite(value), "is not finite");
    return value;
  }

  double positive() const {
    const double value = number();
    require(value > 0.0, "has to be > 0");
    return value;
  }

  std::vector<double> numbers(std::size_t size) const {
    std::vector<double> values;
    for (const JsonNode& item : items()) {
      values.push_back(item.number());
    }
    require(values.size() == size, "holds " + std::to_string(values.size()) + " numbers; " +
                                       std::to_string(size) + " are needed");
    return values;
  }

  /// The file's first two keys.
  void require_format(const std::string& format, int version) const {
    (*this)["format"].require((*this)["format"].text() == format, "has to be '" + format + "'");
    (*this)["version"].require((*this)["version"].number() == version,
                               "this kelpie reads version " + std::to_string(version));
  }

  void require(bool good, const std::string& otherwise) const {
    if (!good) {
      throw InputError({.file = source_, .line = 0, .field = path_.empty() ? "file" : path_},
                       otherwise);
    }
  }

 private:
  const Json* json_;
  std::string source_;
  std::string path_;
};

/// Throws InputError on text that is no JSON.
Json parse_json(const std::string& text, const std::string& source);

/// A file's content; `what` is needed there. Throws InputError when it can't be read.
std::string json_text(const std::filesystem::path& file, const std::string& what);

}  // namespace kelpie::format
