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

/// The settings of the model that a configuration file gives, as written.
struct SettingsFile {
  /// What one of them is set to.
  struct Value {
    std::string text;  ///< as ModelSettings::assign takes it
    std::size_t line = 0;
  };
  std::string source;  ///< the file, for messages
  std::map<std::string, Value> settings;
};

/// Reads a configuration file (TOML); its tables [log] and [live], which tell of logs and of the
/// vehicle's computer, are passed over. An empty path gives no settings. Throws InputError (file,
/// line, key) on a missing file, TOML that doesn't parse, a value that is no setting's. Names are
/// checked when they are applied.
SettingsFile read_settings_file(const std::filesystem::path& file);
/// The same of the file's top-level table.
SettingsFile read_settings_file(const file::TomlNode& root);

/// The two sides of a `key=value` given to an option. Throws InputError on another form.
std::pair<std::string, std::string> key_and_value(const std::string& assignment,
                                                  const std::string& option = "--set");

/// Preset, then the file, then the `key=value` of --set, each over the one before.
/// Throws InputError naming file, line and key, or "--set", and what would be right.
ModelSettings make_settings(const SettingsFile& file, const std::vector<std::string>& set,
                            std::size_t axes);

/// The same over the settings of a model that is to go on, which keeps its preset.
ModelSettings make_settings(const SettingsFile& file, const std::vector<std::string>& set,
                            ModelSettings start);

}  // namespace kelpie::format
