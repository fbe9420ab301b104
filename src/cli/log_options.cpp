// SPDX-License-Identifier: Apache-2.0
#include "cli/log_options.hpp"

#include "cli/bag_options.hpp"

namespace kelpie::cli {

void add_split_option(CLI::App& command, std::string& split, const std::string& meaning) {
  command.add_option("--split", split, meaning)
      ->capture_default_str()
      ->type_name("{blocks,pieces,tail,random,column:NAME}");
}

void LogOptions::add_to(CLI::App& command) {
  add_bag_options(command, source, "log",
                  "the log: a CSV file with a header, or a ROS 2 bag with --config");
  command.add_option("--inputs", inputs, "columns the model sees, separated by commas")
      ->delimiter(',');
  command.add_option("--targets", targets, "columns it predicts, separated by commas")
      ->delimiter(',');
  CLI::Option* const time_option = command.add_option("--time", time, "column of the time [s]");
  command.add_option("--rate", rate_hz, "rows per second, where there is no time column [Hz]")
      ->excludes(time_option);
  command.add_option("--configuration", configuration,
                     "column numbering the vehicle's configuration");
}

log::Roles LogOptions::over(const log::Roles& file) const {
  log::Roles roles = file;
  if (!inputs.empty()) {
    roles.inputs = inputs;
  }
  if (!targets.empty()) {
    roles.targets = targets;
  }
  if (!configuration.empty()) {
    roles.configuration = configuration;
  }
  if (!time.empty() || rate_hz != 0.0) {
    roles.time = time;
    roles.rate_hz = rate_hz;
  }
  return roles;
}

SplitLog open_split_log(const LogOptions& options, const std::string& config,
                        const std::string& split, std::uint64_t seed) {
  const log::LogConfig read = log::read_log_config(config);
  const study::SplitSettings settings = study::parse_split(split, seed);
  log::Roles roles = options.over(read.roles);
  roles.held_out = settings.column;
  SplitLog log{open_log(options.source, read, roles).dataset(), {}};
  log.split = study::make_split(log.data, settings);
  return log;
}

}  // namespace kelpie::cli
