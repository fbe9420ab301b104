// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "file/toml.hpp"
#include "fleet/log_pattern.hpp"
#include "format/settings_file.hpp"
#include "log/read_log.hpp"

namespace kelpie::fleet {

/// Settings that are compared with those of other learners.
struct LearnerConfig {
  std::string name;
  std::vector<std::string> set;  ///< as --set takes them, the preset first
};

/// Rows held out, as --split and --seed say it.
struct SplitOptions {
  std::string split;
  std::uint64_t seed = 1;  ///< 1 for all splits but `random`
};

/// Logs that are read alike, and how: what `kelpie learn` is told of a log.
struct Source {
  std::string vehicle;  ///< empty: the pattern says, or the folder a log is in
  std::vector<LogPattern> logs;
  std::size_t line = 0;  ///< of the patterns in the study's file
  log::LogConfig log;
  format::SettingsFile settings;  ///< of the file that `config` names; learners go over them
  std::string align = "auto";
  bool recover = false;
  std::string identity;  ///< all that says how logs are read and learned, canonically
};

/// A study over many logs, as its file says it (docs/study.md).
struct Plan {
  std::filesystem::path file;
  std::string name;
  std::vector<Source> sources;
  std::vector<SplitOptions> splits;
  std::vector<LearnerConfig> learners;

  std::filesystem::path folder() const;  ///< of the file, absolute: where relative paths begin
  std::string identity() const;          ///< all of the above but the logs' paths, canonically
};

/// Reads a study's file and the configurations that it names. Throws InputError (file, line, key):
/// no such file, no TOML, an unknown key or setting with the nearest that is, a value out of range.
Plan read_plan(const std::filesystem::path& file);

}  // namespace kelpie::fleet
