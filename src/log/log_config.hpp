// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "bag/series.hpp"
#include "file/toml.hpp"
#include "log/dataset.hpp"
#include "log/sampling.hpp"

namespace kelpie::log {

/// What the table [log] of a configuration file says: which columns of a log play which part, and
/// how its signals become samples (docs/from_topics.md).
struct LogConfig {
  std::string source;  ///< the file, for messages
  Roles roles;
  SamplingPlan plan;  ///< without rate and responses, which the columns' roles tell
  bag::Clock clock = bag::Clock::receive;
  std::filesystem::path messages;  ///< folder of .msg files, or empty

  bool makes_samples() const { return !plan.sources.empty(); }
};

/// Reads a configuration file (TOML); settings of the model in it are passed over. Nothing is
/// said of a log where the file has no [log], or the path is empty.
/// Throws InputError (file, line, key): no such file, no TOML, a value of a wrong kind, a name
/// that isn't known, with the nearest that is.
LogConfig read_log_config(const std::filesystem::path& file);
/// The same of the file's top-level table.
LogConfig read_log_config(const file::TomlNode& root);

}  // namespace kelpie::log
