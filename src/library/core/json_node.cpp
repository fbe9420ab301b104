// SPDX-License-Identifier: Apache-2.0
#include "core/json_node.hpp"

#include <array>
#include <cmath>

#include "kelpie/core/error.hpp"

namespace kelpie {

namespace {

// Before the parse: who copies or reads a value recurses, and an object looks for each new key
// among all earlier ones.
void check_shape(std::string_view text, const std::string& source) {
  std::array<std::size_t, kDeepestJson + 1> keys{};  // of the open lists and objects
  std::size_t depth = 0;
  const auto require = [&](bool holds, std::size_t most, const char* what) {
    if (!holds) {
      throw InputError(
          {.file = source, .field = "file"},
          "has more than " + std::to_string(most) + " " + what + "; no file of kelpie's has");
    }
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char letter = text[i];
    if (letter == '"') {
      while (++i < text.size() && text[i] != '"') {
        i += text[i] == '\\' ? 1 : 0;
      }
    } else if (letter == ']' || letter == '}') {
      depth -= depth > 0 ? 1 : 0;
    } else if (letter == '[' || letter == '{') {
      require(depth < kDeepestJson, kDeepestJson, "lists and objects within each other");
      keys[++depth] = 0;
    } else if (letter == ':') {
      require(++keys[depth] <= kMostJsonKeys, kMostJsonKeys, "keys in an object");
    }
  }
}

}  // namespace

Json parse_json(std::string_view text, const std::string& source,
                const Json::parser_callback_t& callback) {
  check_shape(text, source);
  try {
    return Json::parse(text, callback);
  } catch (const Json::out_of_range& error) {
    throw InputError({.file = source, .field = "file"},
                     std::string("holds a number out of a double's range: ") + error.what());
  } catch (const Json::parse_error& error) {
    throw InputError({.file = source, .field = "file"},
                     "is not JSON (from byte " + std::to_string(error.byte) +
                         " on): another file was given, or this one is damaged");
  }
}

Json json_or_discarded(std::string_view text) {
  try {
    return parse_json(text, "");
  } catch (const InputError&) {
    return Json::value_t::discarded;
  }
}

JsonNode JsonNode::operator[](const std::string& key) const {
  require(json_->is_object() && json_->contains(key), "has no '" + key + "'");
  return {(*json_)[key], source_, path_.empty() ? key : path_ + "." + key};
}

std::string JsonNode::text() const {
  require(json_->is_string(), "is not a text");
  return json_->get<std::string>();
}

double JsonNode::number() const {
  require(json_->is_number(), "is not a number");
  const auto value = json_->get<double>();
  require(std::abs(value) <= kLargest, "is out of range; kelpie writes numbers within ±1e100");
  return value;
}

double JsonNode::positive() const {
  const double value = number();
  require(value > 0.0, "has to be > 0");
  return value;
}

std::vector<JsonNode> JsonNode::items() const {
  require(json_->is_array(), "is not a list");
  std::vector<JsonNode> list;
  for (std::size_t i = 0; i < json_->size(); ++i) {
    list.emplace_back((*json_)[i], source_, path_ + "[" + std::to_string(i) + "]");
  }
  return list;
}

std::vector<double> JsonNode::numbers(std::size_t size) const {
  std::vector<double> values;
  for (const JsonNode& item : items()) {
    values.push_back(item.number());
  }
  require(values.size() == size, "holds " + std::to_string(values.size()) + " numbers; " +
                                     std::to_string(size) + " are needed");
  return values;
}

std::vector<std::string> JsonNode::names(std::size_t most) const {
  std::vector<std::string> texts;
  for (const JsonNode& item : items()) {
    texts.push_back(item.text());
  }
  require(!texts.empty() && texts.size() <= most, "needs 1 to " + std::to_string(most) + " names");
  return texts;
}

void JsonNode::require_format(const std::string& format, int version) const {
  (*this)["format"].require((*this)["format"].text() == format, "has to be '" + format + "'");
  (*this)["version"].require((*this)["version"].number() == version,
                             "this kelpie reads version " + std::to_string(version));
}

void JsonNode::require(bool good, const std::string& otherwise) const {
  if (!good) {
    throw InputError({.file = source_, .field = path_.empty() ? "file" : path_}, otherwise);
  }
}

}  // namespace kelpie
