// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/sampling_config.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/settings.hpp"
#include "log/dataset.hpp"

namespace kelpie::cli {

/// What a configuration file says: the settings of the model, and (table [log]) which columns of a
/// log play which part and what signals they are made of.
struct ConfigFile {
  struct Value {
    std::string text;  ///< as ModelSettings::assign takes it
    std::size_t line = 0;
  };
  std::string source;
  std::map<std::string, Value> settings;
  log::Roles roles;
  SamplingConfig sampling;
};

/// Throws InputError (file, line, key) on a missing file, TOML that doesn't parse, a value of a
/// wrong type, or an unknown key in [log]. Names of settings are checked when they are applied.
ConfigFile read_config(const std::filesystem::path& file);

/// The two sides of a `key=value` given to an option. Throws InputError on another form.
std::pair<std::string, std::string> key_and_value(const std::string& assignment,
                                                  const std::string& option = "--set");

/// Preset, then the file, then the `key=value` of --set, each over the one before.
/// Throws InputError naming file, line and key, or "--set", and what would be right.
ModelSettings make_settings(const ConfigFile& file, const std::vector<std::string>& set,
                            std::size_t axes);

}  // namespace kelpie::cli
