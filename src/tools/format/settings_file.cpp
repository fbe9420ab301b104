// SPDX-License-Identifier: Apache-2.0
#include "format/settings_file.hpp"

#include <utility>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::format {
namespace {

// Runs `set`, and gives an error from it the place where the value was written.
template <typename Set>
void at_place(const std::string& file, std::size_t line, Set set) {
  try {
    set();
  } catch (const InputError& error) {
    throw InputError({.file = file, .line = line, .field = error.place().field}, error.message());
  }
}

// What file and --set say of the preset, each in turn.
template <typename Start>
void for_preset(const SettingsFile& file, const std::vector<std::string>& set, Start start) {
  if (const auto found = file.settings.find("preset"); found != file.settings.end()) {
    at_place(file.source, found->second.line, [&] { start(found->second.text); });
  }
  for (const std::string& assignment : set) {
    if (const auto [key, value] = key_and_value(assignment); key == "preset") {
      at_place("--set", 0, [&, &preset = value] { start(preset); });
    }
  }
}

// All other settings, the file's first.
ModelSettings assigned(const SettingsFile& file, const std::vector<std::string>& set,
                       ModelSettings settings) {
  const auto assign = [&](const std::string& key, const std::string& value) {
    if (key != "preset") {
      settings.assign(key, value);
      settings.validate();
    }
  };
  for (const auto& [key, value] : file.settings) {
    at_place(file.source, value.line, [&, &k = key, &v = value] { assign(k, v.text); });
  }
  for (const std::string& assignment : set) {
    const auto parts = key_and_value(assignment);
    at_place("--set", 0, [&] { assign(parts.first, parts.second); });
  }
  return settings;
}

}  // namespace

SettingsFile read_settings_file(const std::filesystem::path& file) {
  return file.empty() ? SettingsFile{} : read_settings_file(file::TomlNode::read(file));
}

SettingsFile read_settings_file(const file::TomlNode& root) {
  SettingsFile content;
  content.source = root.place().file;
  for (const file::TomlNode& member : root.members()) {
    if (member.type() != file::TomlNode::Type::table ||
        (member.key() != "log" && member.key() != "live")) {
      content.settings[member.key()] = {member.setting(), member.place().line};
    }
  }
  return content;
}

std::pair<std::string, std::string> key_and_value(const std::string& assignment,
                                                  const std::string& option) {
  const std::size_t sign = assignment.find('=');
  if (sign == std::string::npos || sign == 0) {
    throw InputError({.file = option, .line = 0, .field = {}},
                     "'" + printable(assignment) + "' is not of the form key=value");
  }
  return {std::string(trimmed(assignment.substr(0, sign))),
          std::string(trimmed(assignment.substr(sign + 1)))};
}

ModelSettings make_settings(const SettingsFile& file, const std::vector<std::string>& set,
                            std::size_t axes) {
  ModelSettings start = ModelSettings::from_preset("default", axes);
  for_preset(file, set,
             [&](const std::string& preset) { start = ModelSettings::from_preset(preset, axes); });
  return assigned(file, set, std::move(start));
}

ModelSettings make_settings(const SettingsFile& file, const std::vector<std::string>& set,
                            ModelSettings start) {
  for_preset(file, set, [&](const std::string& preset) {
    if (preset != start.preset) {
      throw InputError("preset", "'" + preset +
                                     "' is another than that of the model to go on "
                                     "with, '" +
                                     start.preset + "'");
    }
  });
  return assigned(file, set, std::move(start));
}

}  // namespace kelpie::format
