// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/bag_options.hpp"
#include "cli/config_file.hpp"
#include "log/dataset.hpp"

namespace kelpie::cli {

/// A log as a table, whatever it was.
struct Log {
  log::Table table;
  log::Roles roles;   ///< as given, with the time and rate of the table
  std::string notes;  ///< for people: what was done to its signals; empty: it is a table as it was
};

/// Reads a CSV file or a bag. Where the configuration names states or commands, its signals are put
/// on a common clock (docs/from_topics.md); a bag needs that. What a damaged bag lost is said on
/// stderr.
/// Throws InputError: what reading and sampling throw; a bag without named columns, a rate or time
/// that is missing or has no meaning.
Log read_log(const BagOptions& source, const ConfigFile& config, const log::Roles& roles);

}  // namespace kelpie::cli
