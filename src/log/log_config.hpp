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

/// How a whole log becomes samples: the plan of `config` with a rate, and with the targets that
/// lags are estimated from. `roles` are those of `config`, or over them.
/// Throws InputError (file, log.rate) where no rate is given.
SamplingPlan sampling_plan(const LogConfig& config, const Roles& roles);

/// How live messages become samples, the same as those of a log of them (SampleStream): the plan
/// with inputs and targets too, which are guessed from the names where `roles` has none.
/// Throws as sampling_plan and guess_roles do, and where a lag is to be estimated.
StreamPlan stream_plan(const LogConfig& config, const Roles& roles);

}  // namespace kelpie::log
