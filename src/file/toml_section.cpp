// SPDX-License-Identifier: Apache-2.0
#include "file/toml_section.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::file {
namespace {

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() || key.empty() ? path + key : path + "." + key;
}

[[noreturn]] void reject_node(const toml::node& node, const std::string& file,
                              const std::string& path, const std::string& why) {
  throw InputError({.file = file, .line = node.source().begin.line, .field = path}, why);
}

}  // namespace

toml::table parse_toml(const std::filesystem::path& file) {
  const std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf())) {
    throw InputError({.file = file.string(), .line = 0, .field = {}},
                     "can't be read or is empty; it should be a TOML file");
  }
  try {
    return toml::parse(text.str(), file.string());
  } catch (const toml::parse_error& error) {
    throw InputError({.file = file.string(), .line = error.source().begin.line, .field = {}},
                     std::string(error.description()));
  }
}

TomlSection::TomlSection(const toml::table& table, std::string file, std::string path,
                         const std::vector<std::string>& keys)
    : table_(&table), file_(std::move(file)), path_(std::move(path)) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (std::find(keys.begin(), keys.end(), name) == keys.end()) {
      throw InputError(
          {.file = file_, .line = key.source().begin.line, .field = path_of(name)},
          "unknown key" + did_you_mean(name, keys) + "; known here: " + join_text(keys, ", "));
    }
  }
}

double TomlSection::number(const std::string& key) const {
  return finite(at(key), key);
}

double TomlSection::number(const std::string& key, double otherwise) const {
  return has(key) ? number(key) : otherwise;
}

std::string TomlSection::text(const std::string& key) const {
  const toml::value<std::string>* const value = at(key).as_string();
  if (value == nullptr) {
    reject(key, "must be a text in double quotes");
  }
  return value->get();
}

std::uint64_t TomlSection::count(const std::string& key) const {
  const toml::value<std::int64_t>* const value = at(key).as_integer();
  if (value == nullptr || value->get() < 0) {
    reject(key, "must be a whole number, 0 or more");
  }
  return static_cast<std::uint64_t>(value->get());
}

void TomlSection::numbers(const std::string& key, std::span<double> values) const {
  fill(at(key), key, values);
}

TomlSection TomlSection::section(const std::string& key,
                                 const std::vector<std::string>& keys) const {
  const toml::table* const table = at(key).as_table();
  if (table == nullptr) {
    reject(key, "must be a table");
  }
  return {*table, file_, path_of(key), keys};
}

std::vector<TomlSection> TomlSection::sections(const std::string& key,
                                               const std::vector<std::string>& keys) const {
  const toml::array* const array = at(key).as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    reject(key, "must be one or more tables, each under [[" + key + "]]");
  }
  std::vector<TomlSection> sections;
  for (const toml::node& node : *array) {
    const std::string path = path_of(key) + "[" + std::to_string(sections.size()) + "]";
    sections.emplace_back(*node.as_table(), file_, path, keys);
  }
  return sections;
}

void TomlSection::reject(const std::string& key, const std::string& why) const {
  const toml::node* const node = table_->get(key);
  reject_node(node == nullptr ? *table_ : *node, file_, path_of(key), why);
}

std::string TomlSection::path_of(const std::string& key) const {
  return joined(path_, key);
}

const toml::node& TomlSection::at(const std::string& key) const {
  const toml::node* const node = table_->get(key);
  if (node == nullptr) {
    reject(key, "is missing");
  }
  return *node;
}

double TomlSection::finite(const toml::node& node, const std::string& key) const {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) {
    reject_node(node, file_, path_of(key), "must be a finite number");
  }
  return *value;
}

void TomlSection::fill(const toml::node& node, const std::string& key,
                       std::span<double> values) const {
  const toml::array* const array = node.as_array();
  if (array == nullptr || array->size() != values.size()) {
    reject_node(node, file_, path_of(key),
                "must be an array of " + std::to_string(values.size()) + " numbers");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = finite((*array)[i], key);
  }
}

void TomlSection::square_numbers(const std::string& key, std::span<double> values,
                                 std::size_t size) const {
  const toml::node& node = at(key);
  const toml::array* const rows = node.as_array();
  if (rows == nullptr || rows->size() != size) {
    reject(key, "must be an array of " + std::to_string(size) + " numbers, the diagonal, or of " +
                    std::to_string(size) + " such arrays, the rows of a matrix");
  }
  std::fill(values.begin(), values.end(), 0.0);
  if (!(*rows)[0].is_array()) {
    std::vector<double> diagonal(size);
    fill(node, key, diagonal);
    for (std::size_t i = 0; i < size; ++i) {
      values[i * size + i] = diagonal[i];
    }
    return;
  }
  for (std::size_t i = 0; i < size; ++i) {
    fill((*rows)[i], key, values.subspan(i * size, size));
  }
}

void locate_errors(const toml::table& root, const std::string& file,
                   const std::function<void()>& check) {
  try {
    check();
  } catch (const InputError& error) {
    const std::string& field = error.place().field;
    std::string path = field;
    while (!path.empty() && !root.at_path(path)) {
      path.resize(path.find_last_of(".[") == std::string::npos ? 0 : path.find_last_of(".["));
    }
    const toml::node& node = path.empty() ? root : *root.at_path(path).node();
    const std::string text = error.what();
    reject_node(node, file, field, text.substr(std::min(text.size(), field.size() + 2)));
  }
}

}  // namespace kelpie::file
