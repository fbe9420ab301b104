// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "bag/series.hpp"
#include "file/toml_node.hpp"
#include "log/sampling.hpp"

namespace kelpie::cli {

/// How a log's signals become samples: what the table [log] of a configuration file says of it
/// (docs/from_topics.md).
struct SamplingConfig {
  log::SamplingPlan plan;  ///< without rate and responses, which the columns' roles tell
  bag::Clock clock = bag::Clock::receive;
  std::filesystem::path messages;  ///< folder of .msg files, or empty

  bool is_given() const { return !plan.sources.empty(); }
};

/// The keys of [log] that are read here.
std::span<const std::string> sampling_keys();

/// Throws InputError (file, line, key) on values of a wrong kind and, naming the nearest, names
/// that aren't known.
SamplingConfig read_sampling(const file::TomlNode& log);

}  // namespace kelpie::cli
