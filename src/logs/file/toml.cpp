// SPDX-License-Identifier: Apache-2.0
#include "file/toml.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "file/content.hpp"
#include "file/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"

namespace kelpie::file {
namespace {

// Where the string ends that begins at `begin`: its last quote, or what breaks it off.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const std::string three(3, text[begin]);
  const bool is_long = text.substr(begin).starts_with(three);
  for (std::size_t i = begin + (is_long ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && text[begin] == '"') {
      ++i;
    } else if (is_long ? text.substr(i).starts_with(three)
                       : text[i] == text[begin] || text[i] == '\n') {
      return is_long ? i + 2 : i;
    }
  }
  return text.size();
}

// Throws InputError on a key of more than 16 parts with dots: parser and tables recurse over them.
void check_toml_keys(std::string_view text, const std::string& file) {
  constexpr std::size_t kMostParts = 16;
  std::size_t parts = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"' || text[i] == '\'') {
      i = end_of_string(text, i);
    } else if (text[i] == '#') {
      i = std::min(text.find('\n', i), text.size() - 1);
      parts = 1;
    } else if (std::string_view("\n=,[]{}").find(text[i]) != std::string_view::npos) {
      parts = 1;
    } else if (text[i] == '.' && ++parts > kMostParts) {
      const auto line = 1 + std::ranges::count(text.substr(0, i), '\n');
      throw InputError({.file = file, .line = static_cast<std::size_t>(line)},
                       "a key of more than " + std::to_string(kMostParts) +
                           " dotted parts; no setting has so many");
    }
  }
}

}  // namespace

struct TomlNode::Value {
  std::shared_ptr<const toml::table> root;
  const toml::node* node;
  std::string file;
  std::string path;
  std::string key;

  std::shared_ptr<const Value> child(const std::string& name, const toml::node& value) const {
    const std::string place = path.empty() ? name : path + "." + name;
    return std::make_shared<Value>(Value{root, &value, file, place, name});
  }

  // What is wrong stands at `where`, which may be a part of this value.
  [[noreturn]] void refuse(const toml::node& where, const std::string& why) const {
    throw InputError({.file = file, .line = where.source().begin.line, .field = path}, why);
  }

  const toml::table& table(const std::string& kind) const {
    if (!node->is_table()) {
      refuse(*node, "has to be " + kind);
    }
    return *node->as_table();
  }

  double finite(const toml::node& where, const std::string& kind) const {
    const double value = where.is_number() ? where.value_or(0.0) : NAN;
    if (!std::isfinite(value)) {
      refuse(where, "has to be " + kind);
    }
    if (std::abs(value) > kTuning.largest_toml) {
      refuse(where, number_text(value) + " is out of range; numbers go to ±" +
                        number_text(kTuning.largest_toml));
    }
    return value + 0.0;  // -0 would pass for a value that is given
  }

  std::string setting(const toml::node& where) const {
    if (const auto* const number = where.as_floating_point()) {
      return number_text(number->get());
    }
    if (const auto* const number = where.as_integer()) {
      return std::to_string(number->get());
    }
    if (const auto* const text = where.as_string()) {
      return text->get();
    }
    const toml::array* const list = where.as_array();
    if (list == nullptr) {
      refuse(where, "is neither a number, a text nor a list of these");
    }
    std::vector<std::string> parts;
    for (const toml::node& item : *list) {
      if (item.is_array()) {
        refuse(item, "is a list of lists; one value per target is wanted");
      }
      parts.push_back(setting(item));
    }
    return join_text(parts, ",");
  }
};

TomlNode TomlNode::read(const std::filesystem::path& file) {
  return parse(read_content(file, "a TOML file", kTuning.configuration_bytes), file.string());
}

TomlNode TomlNode::parse(const std::string& content, const std::string& file) {
  check_toml_keys(content, file);
  try {
    auto root = std::make_shared<const toml::table>(toml::parse(content, file));
    const toml::node* const node = root.get();
    return TomlNode(std::make_shared<Value>(Value{std::move(root), node, file, {}, {}}));
  } catch (const toml::parse_error& error) {
    throw InputError({.file = file, .line = error.source().begin.line},
                     "is not TOML: " + std::string(error.description()));
  }
}

Place TomlNode::place() const {
  return {.file = value_->file, .line = value_->node->source().begin.line, .field = value_->path};
}

const std::string& TomlNode::key() const {
  return value_->key;
}

void TomlNode::refuse(const std::string& why) const {
  value_->refuse(*value_->node, why);
}

TomlNode::Type TomlNode::type() const {
  const toml::node& node = *value_->node;
  return node.is_string()  ? Type::text
         : node.is_array() ? Type::list
         : node.is_table() ? Type::table
                           : Type::other;
}

std::string TomlNode::text(const std::string& kind) const {
  if (type() != Type::text) {
    refuse("has to be " + kind);
  }
  return value_->node->as_string()->get();
}

double TomlNode::number(const std::string& kind) const {
  return value_->finite(*value_->node, kind);
}

std::uint64_t TomlNode::count() const {
  const toml::value<std::int64_t>* const value = value_->node->as_integer();
  if (value == nullptr || value->get() < 0) {
    refuse("has to be a whole number, 0 or more");
  }
  return static_cast<std::uint64_t>(value->get());
}

bool TomlNode::flag() const {
  const toml::value<bool>* const value = value_->node->as_boolean();
  if (value == nullptr) {
    refuse("has to be true or false");
  }
  return value->get();
}

std::string TomlNode::setting() const {
  return value_->setting(*value_->node);
}

std::string TomlNode::canonical() const {
  std::ostringstream text;
  text << toml::json_formatter(*value_->node, toml::format_flags::quote_infinities_and_nans);
  return text.str();
}

std::vector<TomlNode> TomlNode::items(const std::string& kind) const {
  const toml::array* const list = value_->node->as_array();
  if (list == nullptr) {
    refuse("has to be " + kind);
  }
  std::vector<TomlNode> items;
  for (const toml::node& node : *list) {
    Value item = *value_;
    item.node = &node;
    items.push_back(TomlNode(std::make_shared<Value>(std::move(item))));
  }
  return items;
}

const TomlNode& TomlNode::table(const std::vector<std::string>& keys) const {
  for (const TomlNode& member : members()) {
    if (std::ranges::find(keys, member.key()) == keys.end()) {
      member.refuse("unknown key" + did_you_mean(member.key(), keys) + "; the keys are " +
                    join_text(keys, ", "));
    }
  }
  return *this;
}

std::vector<TomlNode> TomlNode::tables(const std::vector<std::string>& keys) const {
  const toml::array* const list = value_->node->as_array();
  if (list == nullptr || !list->is_homogeneous(toml::node_type::table)) {
    refuse("has to be one or more tables, each under [[" + value_->path + "]]");
  }
  std::vector<TomlNode> tables;
  for (const toml::node& node : *list) {
    Value item = *value_;
    item.node = &node;
    item.path += "[" + std::to_string(tables.size()) + "]";
    tables.push_back(TomlNode(std::make_shared<Value>(std::move(item))).table(keys));
  }
  return tables;
}

std::vector<TomlNode> TomlNode::members(const std::string& kind) const {
  std::vector<TomlNode> members;
  for (const auto& [key, node] : value_->table(kind)) {
    members.push_back(TomlNode(value_->child(std::string(key.str()), node)));
  }
  std::ranges::stable_sort(members, [](const TomlNode& a, const TomlNode& b) {
    return a.value_->node->source().begin < b.value_->node->source().begin;
  });
  return members;
}

bool TomlNode::has(const std::string& key) const {
  return value_->table("a table").contains(key);
}

TomlNode TomlNode::operator[](const std::string& key) const {
  const toml::node* const node = value_->table("a table").get(key);
  if (node == nullptr) {
    TomlNode(value_->child(key, *value_->node)).refuse("is missing");
  }
  return TomlNode(value_->child(key, *node));
}

void TomlNode::locate_errors(const std::function<void()>& check) const {
  try {
    check();
  } catch (const InputError& error) {
    const toml::table& table = value_->table("a table");
    const std::string& field = error.place().field;
    std::string path = field;
    while (!path.empty() && !table.at_path(path)) {
      path.resize(path.find_last_of(".[") == std::string::npos ? 0 : path.find_last_of(".["));
    }
    const toml::node& node = path.empty() ? table : *table.at_path(path).node();
    throw InputError({.file = value_->file,
                      .line = node.source().begin.line,
                      .field = value_->path.empty() ? field : value_->path + "." + field},
                     error.message());
  }
}

std::vector<std::string> texts_of(const TomlNode& list, const std::string& kind) {
  std::vector<std::string> texts;
  for (const TomlNode& item : list.items(kind)) {
    if (item.type() != TomlNode::Type::text) {
      list.refuse("has to be " + kind);
    }
    texts.push_back(item.text());
  }
  if (texts.empty()) {
    list.refuse("has to be " + kind);
  }
  return texts;
}

void read_numbers(const TomlNode& list, std::span<double> values) {
  const std::string kind = "an array of " + std::to_string(values.size()) + " numbers";
  const std::vector<TomlNode> items = list.items(kind);
  if (items.size() != values.size()) {
    list.refuse("has to be " + kind);
  }
  std::ranges::transform(items, values.begin(), [](const TomlNode& item) { return item.number(); });
}

}  // namespace kelpie::file
