// SPDX-License-Identifier: Apache-2.0
#include "cli/log_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "chart/wording.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "core/text.hpp"
#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/motion/term_set.hpp"
#include "log/dataset.hpp"
#include "log/plausibility.hpp"
#include "report/sampling_table.hpp"
#include "study/alignment.hpp"
#include "study/baselines.hpp"
#include "study/identification.hpp"

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

// Throws InputError with those that are refused, unless these are accepted; says the others.
// Returns those that were accepted.
std::string tell_mistakes(const std::string& source, const std::string& field,
                          const std::vector<log::Mistake>& found, bool accepts) {
  std::vector<std::string> refused;
  for (const log::Mistake& mistake : found) {
    if (mistake.is_refused) {
      refused.push_back(log::mistake_text(mistake));
    }
    if (!mistake.is_refused || accepts) {
      warn("{}: {}\n", source, log::mistake_text(mistake));
    }
  }
  if (!refused.empty() && !accepts) {
    throw InputError(
        {.file = source, .field = field},
        join_text(refused, "; ") + "; --accept implausible learns the log as it stands");
  }
  return join_text(refused, "; ");
}

// The data of one log; `is_new`: no model wants all its inputs.
log::Dataset dataset_of(log::Log opened, const PlanOptions& options, bool is_new) {
  for (const std::string& name : options.log.also) {
    const std::vector<std::string>& names = opened.table.names;
    if (!options.config.empty() && std::ranges::find(names, name) == names.end()) {
      throw InputError(
          {.file = options.config, .line = 0, .field = "log.states"},
          fmt::format("has no {0}, which an option names; the line {0} = \"COLUMN\" adds one",
                      name));
    }
  }
  opened.roles.also = options.log.also;
  log::Dataset data = is_new ? new_dataset(std::move(opened)) : opened.dataset();
  if (options.since_s) {
    data = log::rows_since(data, *options.since_s);
  }
  check_clock(data, options);
  return data;
}

// The first log says what the columns of all are; what was guessed for it holds for all.
log::Dataset open_logs(const PlanOptions& options, bool is_new, PlannedLog& planned) {
  auto& [config, roles] = planned.reading;
  const log::Log opened = open_log(options.log.source, config, roles);
  std::vector<log::Dataset> logs{dataset_of(opened, options, is_new)};
  roles.inputs = logs.front().input_names;
  roles.targets = logs.front().target_names;
  if (opened.draft) {
    planned.draft = opened.draft->toml();
    config = opened.draft->config;
    roles.time = config.roles.time;
    roles.units.insert(config.roles.units.begin(), config.roles.units.end());
    roles.actuators = opened.roles.actuators;
  }
  for (const std::string& path : options.more) {
    log::LogSource source = options.log.source;
    source.path = path;
    logs.push_back(dataset_of(open_log(source, config, roles), options, false));
  }
  std::ranges::transform(logs, std::back_inserter(planned.learned), format::learned_log);
  return log::joined(std::move(logs));
}

// A mistake in a formula is told with the file that has the formula.
void check_terms(const ModelSettings& settings, const log::Dataset& data,
                 const std::string& config) {
  in_file(config, [&] {
    TermSet::from(settings.shared.terms, data.input_names, data.target_names.size());
  });
}

// Appends an option with a value, unless the value is empty.
void add_option(std::string& text, const char* option, const std::string& value) {
  text += value.empty() ? "" : fmt::format(" {} {}", option, shell_word(value));
}

}  // namespace

void check_clock(const log::Dataset& data, const PlanOptions& options) {
  tell_mistakes(data.source, data.doubts.empty() ? data.time_column : "", log::clock_mistakes(data),
                !options.accept.empty());
}

std::string check_targets(const log::Dataset& data, const std::string& states,
                          const PlanOptions& options) {
  double align_s = 0.0;
  parse_number(options.align, align_s);  // "auto" and "none" are 0 s
  return tell_mistakes(data.source, "targets", log::target_mistakes(data, states, align_s),
                       !options.accept.empty());
}

log::Dataset new_dataset(log::Log opened) {
  warn("{}", log::left_out_text(opened.table, opened.roles));
  opened.roles = log::without_constants(opened.table, std::move(opened.roles));
  return opened.dataset();
}

void add_split_option(CLI::App& command, std::string& split, const std::string& meaning) {
  command.add_option("--split", split, meaning)
      ->capture_default_str()
      ->type_name("{auto,blocks,pieces,tail,random,column:NAME,none}");
}

void LogOptions::add_to(CLI::App& command) {
  add_bag_options(command, source, "log",
                  "the log: " + log_formats() + " (`kelpie inspect` says what is in it)");
  add_columns_to(command);
  command.add_option("--configuration", configuration,
                     "column numbering the vehicle's configuration");
}

bool LogOptions::has_columns() const {
  return !inputs.empty() || !targets.empty() || !ignored.empty() || !time.empty() ||
         rate_hz != 0.0 || !units.empty() || !missing.empty() || !pose.empty();
}

void LogOptions::add_columns_to(CLI::App& command) {
  add_list(&command, "--inputs", inputs, "columns the model sees, separated by commas");
  add_list(&command, "--targets", targets, "columns it predicts, separated by commas");
  add_list(&command, "--ignore", ignored, "columns that are neither, separated by commas");
  add_clock_options(command, time, rate_hz);
  add_units_option(command, units);
  add_missing_option(command, missing);
  add_pose_option(command, pose);
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
  if (!ignored.empty()) {
    roles.ignored = ignored;
  }
  roles.also = also;
  roles.pose = pose;
  roles.missing = missing;
  roles.has_curves = has_curves;
  add_units(units, roles.units);
  return roles;
}

std::string LogOptions::text() const {
  std::string text;
  add_option(text, "--msg-dir", source.definitions);
  text += source.mode == bag::ReadMode::recover  ? " --recover"
          : source.mode == bag::ReadMode::strict ? " --strict"
                                                 : "";
  add_option(text, "--time", time);
  add_option(text, "--rate", rate_hz > 0.0 ? fmt::format("{}", rate_hz) : "");
  add_option(text, "--units", join_text(units, ","));
  add_option(text, "--missing", join_text(missing, ","));
  add_option(text, "--pose", join_text(pose, ","));
  add_option(text, "--configuration", configuration);
  return text;
}

std::vector<std::string> PlanOptions::files() const {
  std::vector<std::string> files = more;
  files.insert(files.end(), {log.source.path, config});
  return files;
}

std::string PlanOptions::reading_text() const {
  LogOptions reading = log;
  reading.configuration.clear();  // models know no configurations
  std::string text = reading.text();
  add_option(text, "--config", config);
  return text;
}

std::string PlanOptions::judging_text(const std::string& configuration) const {
  std::string text = log.text();
  add_option(text, "--config", configuration);
  add_option(text, "--split", split == PlanOptions().split ? "" : split);
  return text + (seed == PlanOptions().seed ? "" : fmt::format(" --seed {}", seed));
}

std::string PlanOptions::text(const std::string& configuration) const {
  return logs_text() + learning_text(configuration);
}

std::string PlanOptions::logs_text() const {
  std::string logs = shell_word(log.source.path);
  for (const std::string& path : more) {
    logs += " " + shell_word(path);
  }
  return logs;
}

std::string PlanOptions::learning_text(const std::string& configuration) const {
  std::string text = judging_text(configuration);
  add_option(text, "--inputs", join_text(log.inputs, ","));
  add_option(text, "--targets", join_text(log.targets, ","));
  add_option(text, "--ignore", join_text(log.ignored, ","));
  add_option(text, "--since", since_s ? fmt::format("{}", *since_s) : "");
  add_option(text, "--align", align == PlanOptions().align ? "" : align);
  add_option(text, "--current", has_current && current == "none" ? current : "");
  for (const std::string& name : accept) {
    add_option(text, "--accept", name);
  }
  for (const std::string& assignment : set) {
    add_option(text, "--set", assignment);
  }
  return text;
}

PlannedLog plan_log(const PlanOptions& options, const format::Origin* from) {
  study::check_align(options.align, "--align");
  require(!options.since_s || options.more.empty(), "--since",
          "is a time of one log; give that log alone");
  const std::optional<file::TomlNode> root =
      options.config.empty() ? std::nullopt : std::optional(file::TomlNode::read(options.config));
  PlannedLog log{.plan = {},
                 .learned = {},
                 .config = root ? format::read_settings_file(*root) : format::SettingsFile{}};
  log.reading.config = root ? log::read_log_config(*root) : log::LogConfig{};
  const study::SplitSettings split = study::parse_split(options.split, options.seed);
  log::Roles& roles = log.reading.roles;
  roles = options.log.over(log.reading.config.roles);
  roles.held_out = split.column;
  if (from != nullptr) {
    take_columns(*from, roles);
    roles.heading = from->alignment().water.heading;
  }
  log::Dataset data = open_logs(options, from == nullptr, log);
  ModelSettings settings =
      from != nullptr ? format::make_settings(log.config, options.set, from->settings())
                      : format::make_settings(log.config, options.set, data.target_names.size());
  check_terms(settings, data, options.config);
  if (options.check_targets) {
    log.doubt = check_targets(data, settings.shared.states, options);
  }
  const format::LearnedLog without_heading =
      format::learned_log(study::without_inputs(data, {data.heading_column}));
  std::optional<AlignmentResult> known;
  if (from != nullptr && options.align == kAlignAuto) {
    known = study::alignment_at(from->alignment(), data.rate_hz, from->file());
  }
  // A model of velocities over ground goes on with velocities over ground.
  const bool over_ground = from != nullptr && from->alignment().water.none();
  log.plan = study::plan_learning(std::move(data), split, std::move(settings), options.align, known,
                                  options.with_lags, over_ground ? "none" : options.current);
  if (!log.plan.current.current.none()) {  // whose model has no heading
    log.learned = {without_heading};
  }
  log.plan.from = from != nullptr ? from->file() : "";
  log.learned = format::with_held_out(std::move(log.learned), log.plan.split.held_out);
  return log;
}

void add_since_option(CLI::App& command, std::optional<double>& since_s) {
  command.add_option(
      "--since", since_s,
      "leave out the rows before this time of the log [s], as before a change of the "
      "vehicle");
}

void add_frame_option(CLI::App& command, std::string& frame) {
  command
      .add_option("--frame", frame,
                  "of the log: sway to port (FLU) or starboard (FRD); without the option FLU in "
                  "the plane, FRD on six axes")
      ->type_name("{FLU,FRD}");
}

Frame body_frame(const std::string& name, bool six_axes) {
  if (name.empty()) {
    return six_axes ? Frame::frd : Frame::flu;
  }
  const Frame frame = frame_from(name);
  require(frame == Frame::flu || frame == Frame::frd, "--frame", "has to be FLU or FRD");
  return frame;
}

void add_align_option(CLI::App& command, std::string& align) {
  command
      .add_option("--align", align,
                  "how much later the commands stand that belong to a row: auto (found on the "
                  "training rows), none, or seconds")
      ->capture_default_str()
      ->type_name("{auto,none,SECONDS}");
}

void add_current_option(CLI::App& command, PlanOptions& options) {
  options.has_current = true;
  options.current = "auto";
  command
      .add_option("--current", options.current,
                  "current of the water: auto (found on the training rows of a log with a heading, "
                  "and taken off the velocities), or none")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str();
}

void add_known_current_option(CLI::App& command, std::string& current) {
  current = kUsualCurrent;
  command
      .add_option("--current", current,
                  "current of the log, for a model of velocities through the water: learned (as "
                  "found in this log when the model learned the log), none, or two speeds [m/s] as "
                  "in 0.2,-0.1: along heading 0 and along a quarter turn")
      ->type_name("{learned,none,C1,C2}")
      ->capture_default_str();
}

void tell_other_units(const TrainedModel& model, const format::ColumnUnits& learned,
                      const std::map<std::string, Unit>& units, const std::string& log) {
  std::vector<std::string> columns = model.input_names;
  std::ranges::copy(model.target_names(), std::back_inserter(columns));
  for (const std::string& column : columns) {
    const auto own = units.find(column);
    const auto known = learned.find(column);
    if (own == units.end() || known == learned.end()) {
      continue;
    }
    const Unit wanted = Unit::parse(known->second);
    if (own->second.text() != wanted.text()) {
      const bool converts = own->second.in_si().first.text() == wanted.text();
      warn("{}: WARNING: {} is in {}, and the model learned {}{}\n", log, column,
           chart::unit_text(own->second.text()), chart::unit_text(wanted.text()),
           converts ? "; --units " + shell_word(column + "=" + own->second.text()) + " converts"
                    : "");
    }
  }
}

void settle_current(const std::string& wish, bool is_learned, const std::string& log,
                    TrainedModel& model) {
  Current& water = model.alignment.water;
  if (water.none() || wish == "none") {
    water.times_s.clear();
    water.velocity.clear();
    return;
  }
  if (wish == kUsualCurrent) {
    if (!is_learned) {
      throw InputError(
          {.file = log, .line = 0, .field = "--current"},
          "is not known: the model is of velocities through the water, and did not "
          "learn this log with rows held out. Give --current none (velocities through "
          "the water), or --current C1,C2 in m/s; `kelpie learn` of this log estimates "
          "the current");
    }
    return;
  }
  const std::vector<std::string> parts = split_text(wish, ',');
  std::array<double, 2> speeds{};
  require(parts.size() == 2 && parse_number(parts[0], speeds[0]) &&
              parse_number(parts[1], speeds[1]) && std::isfinite(speeds[0]) &&
              std::isfinite(speeds[1]),
          "--current", "'" + wish + "' is neither learned nor none nor two speeds, as in 0.2,-0.1");
  water.times_s = {0.0};
  water.velocity = {speeds};
}

void add_accept_option(CLI::App& command, std::vector<std::string>& accept) {
  command
      .add_option("--accept", accept,
                  "learn a log that is refused otherwise: implausible (targets that cannot be the "
                  "accelerations of the velocities, stamps that stand still)")
      ->allow_extra_args(false)
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

void add_units_option(CLI::App& command, std::vector<std::string>& units) {
  add_list(&command, "--units", units,
           "units of columns in the log, as in r=deg/s,u=cm/s,th1=rev/s: degrees, mm, cm, km, "
           "knots, g and time stamps (t=ms) are converted to the SI");
}

void add_missing_option(CLI::App& command, std::vector<std::string>& missing) {
  add_list(&command, "--missing", missing,
           "values that stand for none, as in -999 or u=0; none: velocities are measured in every "
           "row, whatever flags, marks and zeros say");
}

void add_identification_options(CLI::App& command, IdentificationOptions& options) {
  options.log.add_to(command);
  add_files(&command, "more", options.more, "logs of the same columns, joined to the first");
  add_since_option(command, options.since_s);
  add_align_option(command, options.align);
  add_file(&command, "--config", options.config, "TOML file; its [log] says what is in the log");
  add_set(&command, options.set, "states=SURGE,SWAY,YAW where names don't tell");
  add_list(&command, "--thrusters", options.thrusters,
           "inputs that are thrusters' speeds, separated by commas; else by their names");
  add_list(&command, "--thrust", options.thrust,
           "gives the scale: NAME=K, forward thrust K n² in N (repeatable: the mean)");
  command.add_option("--only", options.only,
                     "number of the configuration; else the first in the log");
  add_accept_option(command, options.accept);
}

std::vector<std::pair<std::string, double>> known_thrusts(const std::vector<std::string>& thrust) {
  std::vector<std::pair<std::string, double>> known;
  for (const std::string& assignment : thrust) {
    const auto [name, text] = format::key_and_value(assignment, "--thrust");
    double value = 0.0;
    if (!parse_number(text, value) || !(value > 0.0) || value > study::kMostThrust) {
      throw InputError("--thrust", "'" + text + "' of '" + name +
                                       "' has to be a number > 0, up to 1e+09, in N per square of "
                                       "the thruster's unit");
    }
    known.emplace_back(name, value);
  }
  return known;
}

void add_pose_option(CLI::App& command, std::vector<std::string>& pose) {
  add_list(&command, "--pose", pose,
           "columns of a CSV file with poses in place of velocities, as in x,y,psi or "
           "z=altitude: velocities and accelerations become integrals over a window that is found");
}

void add_units(const std::vector<std::string>& assignments,
               std::map<std::string, std::string>& units) {
  for (const std::string& assignment : assignments) {
    const auto [column, unit] = format::key_and_value(assignment, "--units");
    units[column] = unit;
  }
}

std::string log_formats() {
  return "a CSV file, " + bag::recording_formats();
}

void add_bag_options(CLI::App& command, log::LogSource& source, const std::string& name,
                     const std::string& meaning) {
  add_file(&command, name, source.path, meaning)->required();
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
    say("{}", log.draft->summary());
  }
  if (log.disarmed > 0) {
    say("left out: {} messages while the motors were disarmed (armed_only)\n", log.disarmed);
  }
  say("{}",
      is_brief() ? report::sampling_notes(log.sampling) : report::sampling_table(log.sampling));
  return log;
}

}  // namespace kelpie::cli
