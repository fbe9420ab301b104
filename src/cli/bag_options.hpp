// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bag/open_bag.hpp"
#include "log/read_log.hpp"

namespace kelpie::cli {

/// "a CSV file, " and bag::recording_formats().
std::string log_formats();

/// Adds the log as a positional argument `name` with the help `meaning`, and the options for
/// reading recordings.
void add_bag_options(CLI::App& command, log::LogSource& source, const std::string& name = "bag",
                     const std::string& meaning = bag::recording_formats());

/// log::read_log() with a report: resampling of signals on stdout, losses of a damaged bag on
/// stderr.
log::Log open_log(const log::LogSource& source, const log::LogConfig& config,
                  const log::Roles& roles);

}  // namespace kelpie::cli
