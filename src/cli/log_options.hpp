// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "log/read_log.hpp"

namespace kelpie::cli {

/// The options that say what stands in a log; whatever is left open is guessed from the header.
struct LogOptions {
  log::LogSource source;
  std::vector<std::string> inputs;
  std::vector<std::string> targets;
  std::string time;
  std::string configuration;
  double rate_hz = 0.0;

  void add_to(CLI::App& command);

  /// These options over those of a configuration file.
  log::Roles over(const log::Roles& file) const;
};

/// The option that says how commands are shifted (study::choose_alignment).
void add_align_option(CLI::App& command, std::string& align);

/// The options of a log's clock.
void add_clock_options(CLI::App& command, std::string& time, double& rate_hz);

}  // namespace kelpie::cli
