// SPDX-License-Identifier: Apache-2.0
#include "cli/bag_options.hpp"

#include "cli/output.hpp"
#include "report/sampling_table.hpp"

namespace kelpie::cli {

std::string log_formats() {
  return "a CSV file, " + bag::recording_formats();
}

void add_bag_options(CLI::App& command, log::LogSource& source, const std::string& name,
                     const std::string& meaning) {
  command.add_option(name, source.path, meaning)->required()->type_name("FILE");
  command
      .add_option("--msg-dir", source.definitions,
                  "folder of .msg files, for types that the bag doesn't define")
      ->type_name("FOLDER");
  command.add_flag("--recover", source.recover,
                   "read what can be read of a damaged bag, and say what was lost");
}

log::Log open_log(const log::LogSource& source, const log::LogConfig& config,
                  const log::Roles& roles) {
  log::Log log = log::read_log(source, config, roles);
  warn("{}", log.losses);
  if (log.draft) {
    say("{}", log.draft->summary(source.path));
  }
  say("{}", report::sampling_table(log.sampling));
  return log;
}

}  // namespace kelpie::cli
