// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "log/read_log.hpp"

namespace kelpie::cli {

/// What is read.
constexpr const char* kRecordingFormats =
    "a rosbag2 folder, or one .db3, .mcap, .bag, .tlog, .BIN, .ulg, .alog or .mat file";
constexpr const char* kLogFormats =
    "a CSV file, a rosbag2 folder, or one .db3, .mcap, .bag, .tlog, .BIN, .ulg, .alog or .mat file";

/// Adds the options that say which log is read, and how. `name` is what the command calls it,
/// `meaning` what it says of it.
void add_bag_options(CLI::App& command, log::LogSource& source, const std::string& name = "bag",
                     const std::string& meaning = kRecordingFormats);

/// log::read_log; says what was done to the signals, and on stderr what a damaged bag lost.
log::Log open_log(const log::LogSource& source, const log::LogConfig& config,
                  const log::Roles& roles);

}  // namespace kelpie::cli
