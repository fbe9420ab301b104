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

/// Name and settings of a learner of a study.
struct LearnerConfig {
  std::string name;
  std::vector<std::string> set;  ///< arguments of --set, the preset first
};

/// Held-out rows: arguments of --split and --seed.
struct SplitOptions {
  std::string split;
  std::uint64_t seed = 1;  ///< 1 except for the split `random`
};

/// Logs that are read in the same way: options of `kelpie learn` about a log.
struct Source {
  std::string vehicle;  ///< empty: named by the pattern, or by the log's folder
  std::vector<LogPattern> logs;
  std::size_t line = 0;  ///< of the patterns in the study's file
  log::LogConfig log;
  format::SettingsFile settings;  ///< of the file `config`; a learner's settings go first
  std::string align = "auto";
  bool recover = false;
  std::string identity;  ///< how logs are read and learned, in canonical form
};

/// Content of a study's file (docs/howto/studies.md).
struct Plan {
  std::filesystem::path file;
  std::string name;
  std::vector<Source> sources;
  std::vector<SplitOptions> splits;
  std::vector<LearnerConfig> learners;

  std::filesystem::path folder() const;  ///< of the file, absolute: base of relative paths
};

/// Reads a study's file and the configurations named in the file. Throws InputError (file, line,
/// key): missing file, no TOML, unknown key or setting (with the nearest known name), value out of
/// range.
Plan read_plan(const std::filesystem::path& file);

}  // namespace kelpie::fleet
