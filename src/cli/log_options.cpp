// SPDX-License-Identifier: Apache-2.0
#include "cli/log_options.hpp"

#include "cli/bag_options.hpp"

namespace kelpie::cli {

void LogOptions::add_to(CLI::App& command) {
  add_bag_options(command, source, "log",
                  "the log: a CSV file with a header, or a ROS 2 bag with --config");
  command.add_option("--inputs", inputs, "columns the model sees, separated by commas")
      ->delimiter(',');
  command.add_option("--targets", targets, "columns it predicts, separated by commas")
      ->delimiter(',');
  add_clock_options(command, time, rate_hz);
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

void add_align_option(CLI::App& command, std::string& align) {
  command
      .add_option("--align", align,
                  "how much later the commands stand that belong to a row: auto (found on the "
                  "training rows), none, or seconds")
      ->capture_default_str()
      ->type_name("{auto,none,SECONDS}");
}

void add_clock_options(CLI::App& command, std::string& time, double& rate_hz) {
  CLI::Option* const time_option = command.add_option("--time", time, "column of the time [s]");
  command.add_option("--rate", rate_hz, "rows per second, where there is no time column [Hz]")
      ->excludes(time_option);
}

}  // namespace kelpie::cli
