// SPDX-License-Identifier: Apache-2.0
#include "cli/config_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "kelpie/core/text.hpp"

namespace kelpie::cli {
namespace {

std::size_t line_of(const toml::node& node) {
  return node.source().begin.line;
}

[[noreturn]] void refuse(const std::string& file, const toml::node& node, const std::string& key,
                         const std::string& message) {
  throw InputError({.file = file, .line = line_of(node), .field = key}, message);
}

// A setting's value as text: numbers and words as they are, lists separated by commas.
std::string value_text(const std::string& file, const std::string& key, const toml::node& node) {
  if (const auto* const number = node.as_floating_point()) {
    return number_text(number->get());
  }
  if (const auto* const number = node.as_integer()) {
    return std::to_string(number->get());
  }
  if (const auto* const text = node.as_string()) {
    return text->get();
  }
  if (const auto* const list = node.as_array()) {
    std::vector<std::string> parts;
    for (const toml::node& item : *list) {
      if (item.is_array()) {
        refuse(file, item, key, "is a list of lists; one value per target is wanted");
      }
      parts.push_back(value_text(file, key, item));
    }
    return join_text(parts, ",");
  }
  refuse(file, node, key, "is neither a number, a text nor a list of these");
}

std::map<std::string, std::string> units(const std::string& file, const std::string& key,
                                         const toml::node& node) {
  const auto* const table = node.as_table();
  if (table == nullptr || !table->is_homogeneous<std::string>()) {
    refuse(file, node, key, "has to be a table of units, as in {u = \"m/s\"}");
  }
  std::map<std::string, std::string> units;
  for (const auto& [column, unit] : *table) {
    units[std::string(column.str())] = unit.as_string()->get();
  }
  return units;
}

log::Roles read_roles(const file::TomlNode& log) {
  std::vector<std::string> known{"inputs", "targets", "time", "rate", "configuration", "units"};
  known.insert(known.end(), sampling_keys().begin(), sampling_keys().end());
  log::Roles roles;
  for (const auto& [key_node, node] : *log.node.as_table()) {
    const std::string key{key_node.str()};
    const file::TomlNode value{log.file, key, node};
    if (key == "inputs") {
      roles.inputs = value.texts();
    } else if (key == "targets") {
      roles.targets = value.texts();
    } else if (key == "time") {
      roles.time = value.text("a column name");
    } else if (key == "configuration") {
      roles.configuration = value.text("a column name");
    } else if (key == "units") {
      roles.units = units(log.file, key, node);
    } else if (key == "rate") {
      roles.rate_hz = value.number("a number of rows per second");
    } else if (std::ranges::find(known, key) == known.end()) {
      refuse(log.file, node, "log." + key,
             "unknown key" + did_you_mean(key, known) + "; the keys are " + join_text(known, ", "));
    }
  }
  return roles;
}

// Runs `set`, and gives an error from it the place where the value was written.
template <typename Set>
void at_place(const std::string& file, std::size_t line, Set set) {
  try {
    set();
  } catch (const InputError& error) {
    throw InputError({.file = file, .line = line, .field = {}}, error.what());
  }
}

}  // namespace

ConfigFile read_config(const std::filesystem::path& file) {
  ConfigFile config;
  config.source = file.string();
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad() || std::filesystem::is_directory(file)) {
    throw InputError({.file = config.source, .line = 0, .field = {}},
                     "cannot be read; --config takes a TOML file (see `kelpie config`)");
  }
  toml::table table;
  try {
    table = toml::parse(content, config.source);
  } catch (const toml::parse_error& error) {
    throw InputError({.file = config.source, .line = error.source().begin.line, .field = {}},
                     "is not TOML: " + std::string(error.description()));
  }
  for (const auto& [key_node, node] : table) {
    const std::string key{key_node.str()};
    if (node.is_table() && key == "log") {
      const file::TomlNode log{config.source, key, node};
      config.roles = read_roles(log);
      config.sampling = read_sampling(log);
    } else {
      config.settings[key] = {value_text(config.source, key, node), line_of(node)};
    }
  }
  return config;
}

std::pair<std::string, std::string> key_and_value(const std::string& assignment,
                                                  const std::string& option) {
  const std::size_t sign = assignment.find('=');
  if (sign == std::string::npos || sign == 0) {
    throw InputError({.file = option, .line = 0, .field = {}},
                     "'" + assignment + "' is not of the form key=value");
  }
  return {std::string(trimmed(assignment.substr(0, sign))),
          std::string(trimmed(assignment.substr(sign + 1)))};
}

ModelSettings make_settings(const ConfigFile& file, const std::vector<std::string>& set,
                            std::size_t axes) {
  std::vector<std::pair<std::string, std::string>> assignments;
  assignments.reserve(set.size());
  for (const std::string& assignment : set) {
    assignments.push_back(key_and_value(assignment));
  }
  ModelSettings settings;
  const auto start = [&](const std::string& preset) {
    settings = ModelSettings::from_preset(preset, axes);
  };
  start("default");
  if (const auto found = file.settings.find("preset"); found != file.settings.end()) {
    at_place(file.source, found->second.line, [&] { start(found->second.text); });
  }
  for (const auto& [key, value] : assignments) {
    if (key == "preset") {
      at_place("--set", 0, [&, &preset = value] { start(preset); });
    }
  }
  for (const auto& [key, value] : file.settings) {
    if (key != "preset") {
      at_place(file.source, value.line, [&, &k = key, &v = value] {
        settings.assign(k, v.text);
        settings.validate();
      });
    }
  }
  for (const auto& [key, value] : assignments) {
    if (key != "preset") {
      at_place("--set", 0, [&, &k = key, &v = value] {
        settings.assign(k, v);
        settings.validate();
      });
    }
  }
  return settings;
}

}  // namespace kelpie::cli
