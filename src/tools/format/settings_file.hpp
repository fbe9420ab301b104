// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "file/toml.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::format {

/// The model settings of a configuration file, as written.
struct SettingsFile {
  /// The value of one setting.
  struct Value {
    std::string text;  ///< as ModelSettings::assign takes it
    std::size_t line = 0;
  };
  std::string source;  ///< the file, for messages
  std::map<std::string, Value> settings;
};

/// Reads a configuration file (TOML) without its tables [log] and [live]. An empty path gives no
/// settings. Throws InputError (file, line, key) on a missing file, invalid TOML, or a value of a
/// wrong type. make_settings() checks the names.
SettingsFile read_settings_file(const std::filesystem::path& file);
/// Reads the top-level table of a parsed file.
SettingsFile read_settings_file(const file::TomlNode& root);

/// The two sides of a `key=value` given to an option. Throws InputError on another form.
std::pair<std::string, std::string> key_and_value(const std::string& assignment,
                                                  const std::string& option = "--set");

/// Preset, then file, then the `key=value` of --set; later values override earlier values. Throws
/// InputError with file, line and key, or "--set", and the allowed values.
ModelSettings make_settings(const SettingsFile& file, const std::vector<std::string>& set,
                            std::size_t axes);

/// Overrides the settings of a continued model, which keeps its preset.
ModelSettings make_settings(const SettingsFile& file, const std::vector<std::string>& set,
                            ModelSettings start);

}  // namespace kelpie::format
