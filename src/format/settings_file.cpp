// SPDX-License-Identifier: Apache-2.0
#include "format/settings_file.hpp"

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::format {
namespace {

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

SettingsFile read_settings_file(const std::filesystem::path& file) {
  return file.empty() ? SettingsFile{} : read_settings_file(file::TomlNode::read(file));
}

SettingsFile read_settings_file(const file::TomlNode& root) {
  SettingsFile content;
  content.source = root.file();
  for (const file::TomlNode& member : root.members()) {
    if (member.key() != "log" || !member.is_table()) {
      content.settings[member.key()] = {member.setting(), member.line()};
    }
  }
  return content;
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

ModelSettings make_settings(const SettingsFile& file, const std::vector<std::string>& set,
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

}  // namespace kelpie::format
