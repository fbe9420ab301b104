// SPDX-License-Identifier: Apache-2.0
#include "cli/log_options.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "cli/options.hpp"
#include "cli/output.hpp"
#include "core/text.hpp"
#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/motion/term_set.hpp"
#include "log/dataset.hpp"
#include "report/sampling_table.hpp"
#include "study/alignment.hpp"
#include "study/plausibility.hpp"

namespace kelpie::cli {
namespace {

constexpr const char* kAlignAuto = "auto";
constexpr const char* kImplausible = "implausible";

// The columns are those of the model that is to go on.
void take_columns(const format::Origin& from, log::Roles& roles) {
  const auto take = [&](const char* option, const std::vector<std::string>& names,
                        std::vector<std::string>& wanted) {
    if (!wanted.empty() && wanted != names) {
      throw InputError(option, "are " + join_text(wanted, ",") + "; " + from.file() +
                                   " is a model of " + join_text(names, ","));
    }
    wanted = names;
  };
  take("--inputs", from.inputs(), roles.inputs);
  take("--targets", from.targets(), roles.targets);
}

log::Dataset dataset_of(const log::Log& opened) {
  warn("{}", log::left_out_text(opened.table, opened.roles));
  return opened.dataset();
}

// The first log says what the columns of all are; what was guessed for it holds for all. `draft`:
// that guess.
log::Dataset open_logs(const log::LogSource& first, const std::vector<std::string>& more,
                       log::LogConfig config, log::Roles roles,
                       std::vector<format::LearnedLog>& learned, std::string& draft) {
  const log::Log opened = open_log(first, config, roles);
  std::vector<log::Dataset> logs{dataset_of(opened)};
  roles.inputs = logs.front().input_names;
  roles.targets = logs.front().target_names;
  if (opened.draft) {
    draft = opened.draft->toml;
    config = opened.draft->config(first.path);
    roles.time = config.roles.time;
    roles.units = opened.roles.units;
    roles.actuators = opened.roles.actuators;
  }
  for (const std::string& path : more) {
    log::LogSource source = first;
    source.path = path;
    logs.push_back(dataset_of(open_log(source, config, roles)));
  }
  std::ranges::transform(logs, std::back_inserter(learned), format::learned_log);
  return log::joined(std::move(logs));
}

// A mistake in a formula is told with the file that has the formula.
void check_terms(const ModelSettings& settings, const log::Dataset& data,
                 const std::string& config) {
  try {
    TermSet::from(settings.shared.terms, data.input_names, data.target_names.size());
  } catch (const InputError& error) {
    throw InputError({.file = config}, error.what());
  }
}

}  // namespace

void add_split_option(CLI::App& command, std::string& split, const std::string& meaning) {
  command.add_option("--split", split, meaning)
      ->capture_default_str()
      ->type_name("{auto,blocks,pieces,tail,random,column:NAME,none}");
}

void LogOptions::add_to(CLI::App& command) {
  add_bag_options(command, source, "log",
                  "the log: " + log_formats() + " (`kelpie inspect` says what is in it)");
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

std::vector<std::string> PlanOptions::files() const {
  std::vector<std::string> files = more;
  files.insert(files.end(), {log.source.path, config});
  return files;
}

PlannedLog plan_log(const PlanOptions& options, const format::Origin* from) {
  study::check_align(options.align, "--align");
  const std::optional<file::TomlNode> root =
      options.config.empty() ? std::nullopt : std::optional(file::TomlNode::read(options.config));
  const log::LogConfig config = root ? log::read_log_config(*root) : log::LogConfig{};
  const study::SplitSettings split = study::parse_split(options.split, options.seed);
  log::Roles roles = options.log.over(config.roles);
  roles.held_out = split.column;
  for (const std::string& assignment : options.units) {
    const auto [column, unit] = format::key_and_value(assignment, "--units");
    roles.units[column] = unit;
  }
  if (from != nullptr) {
    take_columns(*from, roles);
  }
  PlannedLog log{.plan = {},
                 .learned = {},
                 .config = root ? format::read_settings_file(*root) : format::SettingsFile{}};
  log::Dataset data =
      open_logs(options.log.source, options.more, config, roles, log.learned, log.draft);
  ModelSettings settings =
      from != nullptr ? format::make_settings(log.config, options.set, from->settings())
                      : format::make_settings(log.config, options.set, data.target_names.size());
  check_terms(settings, data, options.config);
  if (options.check_targets && options.accept.empty()) {
    study::require_plausible(data, settings.shared.states);
  }
  std::optional<AlignmentResult> known;
  if (from != nullptr && options.align == kAlignAuto) {
    known = study::alignment_at(from->alignment(), data.rate_hz, from->file());
  }
  log.plan = study::plan_learning(std::move(data), split, std::move(settings), options.align, known,
                                  options.with_lags);
  log.plan.from = from != nullptr ? from->file() : "";
  log.learned = format::with_held_out(std::move(log.learned), log.plan.split.held_out);
  return log;
}

void add_align_option(CLI::App& command, std::string& align) {
  command
      .add_option("--align", align,
                  "how much later the commands stand that belong to a row: auto (found on the "
                  "training rows), none, or seconds")
      ->capture_default_str()
      ->type_name("{auto,none,SECONDS}");
}

void add_accept_option(CLI::App& command, std::vector<std::string>& accept) {
  command
      .add_option("--accept", accept,
                  "learn a log that is refused otherwise: implausible (targets that cannot be the "
                  "accelerations of the velocities)")
      ->check(CLI::IsMember({kImplausible}));
}

void add_clock_options(CLI::App& command, std::string& time, double& rate_hz) {
  CLI::Option* const time_option = command.add_option("--time", time, "column of the time [s]");
  constexpr double kSlowestHz = 1e-6;
  constexpr double kFastestHz = 1e6;
  command.add_option("--rate", rate_hz, "rows per second, where there is no time column [Hz]")
      ->check(within(kSlowestHz, kFastestHz))
      ->excludes(time_option);
}

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
  const auto add_mode = [&](const char* flag, bag::ReadMode mode, const char* help) {
    return command.add_flag_callback(
        flag, [&source, mode] { source.mode = mode; }, help);
  };
  add_mode("--recover", bag::ReadMode::recover,
           "read what can be read of a damaged bag, and say what was lost")
      ->excludes(
          add_mode("--strict", bag::ReadMode::strict,
                   "refuse messages with a wrong checksum, which are passed over otherwise"));
}

log::Log open_log(const log::LogSource& source, const log::LogConfig& config,
                  const log::Roles& roles) {
  log::Log log = log::read_log(source, config, roles);
  warn("{}", log.losses);
  if (log.draft) {
    say("{}", log.draft->summary(source.path));
  }
  if (log.disarmed > 0) {
    say("left out: {} messages while the motors were disarmed (armed_only)\n", log.disarmed);
  }
  say("{}", report::sampling_table(log.sampling));
  return log;
}

}  // namespace kelpie::cli
