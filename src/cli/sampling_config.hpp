// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "kelpie/bag/series.hpp"
#include "kelpie/data/sampling.hpp"
#include "toml_node.hpp"

namespace kelpie::cli {

/// How a log's signals become samples: what the table [log] of a configuration file says of it
/// (docs/from_topics.md).
struct SamplingConfig {
  SamplingPlan plan;  ///< without rate and responses, which the columns' roles tell
  Clock clock = Clock::receive;
  std::filesystem::path messages;  ///< folder of .msg files, or empty

  bool is_given() const { return !plan.sources.empty(); }
};

/// The keys of [log] that are read here.
std::span<const std::string> sampling_keys();

/// Throws InputError (file, line, key) on values of a wrong kind and, naming the nearest, names
/// that aren't known.
SamplingConfig read_sampling(const TomlNode& log);

}  // namespace kelpie::cli
