// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_writer.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "log/dataset.hpp"
#include "log/read_log.hpp"

namespace kelpie::cli {
namespace {

struct ConvertArguments {
  log::LogSource bag;
  std::vector<std::string> columns;
  std::string config;
  std::string out;
  std::string clock = "receive";
};

// The samples that `learn` would be shown.
void to_samples(const ConvertArguments& options) {
  if (!options.columns.empty() || !options.out.ends_with(".csv")) {
    throw InputError("--config",
                     "names the columns of a .csv file; give no --columns, and --out ending in "
                     ".csv");
  }
  const log::LogConfig config = log::read_log_config(options.config);
  const log::Log log = open_log(options.bag, config, config.roles);
  log::write_csv(options.out, log.table);
  say("{}: {} rows, {} columns\n", options.out, log.table.rows(), log.table.names.size());
}

void to_csv(const ConvertArguments& options) {
  if (options.columns.empty()) {
    throw InputError("--columns",
                     "is missing; name columns as in /odom:twist.twist.linear.x, or give "
                     "--config with the table [log] (`kelpie inspect BAG --template`)");
  }
  const bag::Clock clock = options.clock == "header" ? bag::Clock::header : bag::Clock::receive;
  const log::Log log = log::read_columns(options.bag, options.columns, clock);
  log::write_csv(options.out, log.table);
  say("{}: {} rows, {} columns\n", options.out, log.table.rows(), log.table.names.size());
  warn("{}", log.losses);
}

void to_mcap(const ConvertArguments& options) {
  if (!options.columns.empty()) {
    throw InputError("--columns", "belongs to CSV files; an MCAP file gets all messages");
  }
  const bag::MessageDefinitions definitions(options.bag.definitions);
  const std::unique_ptr<bag::MessageReader> bag = options.bag.open_bag();
  const bag::McapCopy copy = bag::copy_to_mcap(*bag, definitions);
  file::write_file_whole(options.out, copy.content);
  say("{}: {} messages\n", options.out, copy.messages);
  if (!copy.undefined.empty()) {
    say("without definition (give --msg-dir): {}\n", join_text(copy.undefined, ", "));
  }
  warn("{}", bag->losses_text());
}

// Rows of --columns alone have a choice of clocks.
void check_clock_option(const ConvertArguments& options) {
  require(options.clock == ConvertArguments{}.clock ||
              (options.config.empty() && options.out.ends_with(".csv")),
          "--clock", "is of the rows of --columns; [log] of --config says its own clock");
}

void convert(const ConvertArguments& options) {
  check_clock_option(options);
  check_output("--out", options.out, {options.bag.path, options.config});
  if (!options.config.empty()) {
    to_samples(options);
    return;
  }
  const std::string kind = std::filesystem::path(options.out).extension().string();
  if (kind != ".csv" && kind != ".mcap") {
    throw InputError("--out", "a name ending in .csv or .mcap is due, not " + options.out);
  }
  (kind == ".csv" ? to_csv : to_mcap)(options);
}

}  // namespace

void add_convert(CLI::App& app) {
  const auto [command, options] =
      add_command(app, "convert", "Make a CSV log of a recording, or an MCAP file", convert);
  add_bag_options(*command, options->bag);
  add_list(command, "--columns", options->columns,
           "columns of the CSV file, separated by commas: topic:field, as in "
           "/odom:twist.twist.linear.x; a row per message of the first one's topic");
  add_file(command, "--config", options->config,
           "TOML file whose [log] says how to make samples at a common rate");
  add_file(command, "--out", options->out, "the file to write: .csv or .mcap")->required();
  command->add_option("--clock", options->clock, "times: receive (recorder's) or header (sender's)")
      ->check(CLI::IsMember({"receive", "header"}))
      ->capture_default_str();
  add_examples(command, "convert dive.bag --config vehicle.toml --out dive.csv",
               "convert dive.db3 --out dive.mcap");
}

}  // namespace kelpie::cli
