// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "format/learned_logs.hpp"
#include "format/origin.hpp"
#include "format/settings_file.hpp"
#include "kelpie/model/settings.hpp"
#include "log/read_log.hpp"
#include "study/alignment.hpp"
#include "study/split.hpp"

namespace kelpie::cli {

/// The option --split, `meaning` what it is to this command.
void add_split_option(CLI::App& command, std::string& split, const std::string& meaning);

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

/// Logs learned one after the other, whose rows are split as --split wants it, its commands shifted
/// as --align does, and the settings to learn it with.
struct SplitLog {
  log::Dataset data;
  study::Split split;
  ModelSettings settings;
  AlignmentFound alignment;
  std::vector<format::LearnedLog> learned;  ///< the logs, with the rows that are held out
  format::SettingsFile config;              ///< where the settings come from
  std::string draft{};  ///< the configuration that was guessed for the log, or empty
};

/// What a SplitLog is made by, besides the log's own options.
struct SplitOptions {
  std::string config;            ///< the file that --config names, or empty
  std::vector<std::string> set;  ///< as --set has it
  std::string split;
  std::uint64_t seed = 1;
  std::string align;
  std::vector<std::string> units{};      ///< as --units has them
  std::vector<std::string> more{};       ///< logs that follow the first one
  const format::Origin* from = nullptr;  ///< the model to go on with; null: none
};

/// Says on stderr which columns the guess of inputs leaves out. Reads each file once, so that they
/// may be pipes.
/// Throws what open_log() throws, and InputError where the log can't be split or shifted so.
SplitLog open_split_log(const LogOptions& options, const SplitOptions& wish);

/// The option that says how commands are shifted (study::choose_alignment).
void add_align_option(CLI::App& command, std::string& align);

/// The options of a log's clock.
void add_clock_options(CLI::App& command, std::string& time, double& rate_hz);

}  // namespace kelpie::cli
