// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bag/open_bag.hpp"
#include "format/learned_logs.hpp"
#include "format/model_json.hpp"
#include "format/origin.hpp"
#include "format/settings_file.hpp"
#include "kelpie/motion/frame.hpp"
#include "kelpie/motion/unit.hpp"
#include "log/read_log.hpp"
#include "study/learn.hpp"

namespace kelpie::cli {

/// The options that describe the columns of a log. Columns without an option are guessed from the
/// header.
struct LogOptions {
  log::LogSource source;
  std::vector<std::string> inputs;
  std::vector<std::string> targets;
  std::string time;
  std::string configuration;
  double rate_hz = 0.0;
  std::vector<std::string> ignored;
  std::vector<std::string> units;      ///< column=unit
  std::vector<std::string> also{};     ///< log::Roles::also
  std::vector<std::string> pose{};     ///< log::Roles::pose
  std::vector<std::string> missing{};  ///< log::Roles::missing
  bool has_curves = false;             ///< log::Roles::has_curves

  void add_to(CLI::App& command);
  /// The options of add_to() that say what the columns of a table are.
  void add_columns_to(CLI::App& command);
  /// Whether any option of add_columns_to() was given.
  bool has_columns() const;

  /// These options over the roles of a configuration file. Throws InputError on a unit without
  /// column.
  log::Roles over(const log::Roles& file) const;

  /// These options as a shell takes them, beside the log, without inputs and targets, which a model
  /// knows: " --rate 4 --units r=deg/s".
  std::string text() const;
};

/// The options of a command that learns logs, for a study::LearnPlan.
struct PlanOptions {
  LogOptions log;
  std::vector<std::string> more;  ///< logs joined to the first
  std::string config;             ///< configuration file, or empty
  std::vector<std::string> set;
  std::optional<double> since_s{};  ///< --since: earlier rows are left out
  std::string split = "auto";
  std::string align = "auto";
  std::string current = "none";
  bool has_current = false;           ///< there is the option --current
  bool with_lags = false;             ///< LearnPlan::lags
  bool check_targets = true;          ///< check_targets() in plan_log()
  std::vector<std::string> accept{};  ///< --accept
  std::uint64_t seed = 1;

  std::vector<std::string> files() const;  ///< logs and configuration file

  /// The options by which another log like this one is read, as given: " --rate 4".
  std::string reading_text() const;
  /// The options of a command that judges a model on the log, as given; `configuration`: file ("":
  /// none). " --rate 4 --split tail".
  std::string judging_text(const std::string& configuration) const;
  /// All options of plan_log(), as given.
  std::string learning_text(const std::string& configuration) const;
  /// The logs with learning_text(): "log.csv --rate 4".
  std::string text(const std::string& configuration) const;
  std::string logs_text() const;  ///< The logs as a shell takes them.
};

/// Checks the clock of a log (log::clock_mistakes()). Prints to stderr the mistakes that hardly
/// harm, or that the options accept. Throws InputError (file) with the others.
void check_clock(const log::Dataset& data, const PlanOptions& options);

/// Checks the targets likewise (log::target_mistakes()). Returns the accepted mistakes.
std::string check_targets(const log::Dataset& data, const std::string& states,
                          const PlanOptions& options);

/// How a log is read.
struct LogReading {
  log::LogConfig config;
  log::Roles roles;
};

/// A log, or several joined ones, read and ready to be learned.
struct PlannedLog {
  study::LearnPlan plan;
  std::vector<format::LearnedLog> learned;  ///< the logs with their held-out rows
  format::SettingsFile config;              ///< configuration file of the settings
  std::string draft{};                      ///< the guessed configuration of the log, or empty
  std::string doubt{};                      ///< accepted mistakes of the targets, or empty
  LogReading reading{};                     ///< of another log with these columns, draft included
};

/// Reads the logs, splits their rows and aligns their commands. `from` is the model to continue,
/// with its columns, settings and alignment; null: a new model. Prints to stderr the columns left
/// out of the inputs, and mistakes that hardly harm. Reads each file once, so a log may be a pipe.
/// Throws as open_log() and study::plan_learning() do, and InputError (file) with the mistakes of a
/// log (log/plausibility.hpp) unless the options accept an implausible log.
PlannedLog plan_log(const PlanOptions& options, const format::Origin* from = nullptr);

/// The rows of a log for a new model. Prints to stderr the columns left out of the inputs. Throws
/// as Log::dataset() does.
log::Dataset new_dataset(log::Log opened);

/// The option --split; `meaning` is its purpose in this command.
void add_split_option(CLI::App& command, std::string& split, const std::string& meaning);

/// --since of the commands with plan_log().
void add_since_option(CLI::App& command, std::optional<double>& since_s);

/// The option --align of commands (study::choose_alignment).
void add_align_option(CLI::App& command, std::string& align);

/// The option --frame: body axes of the log where a vehicle file is read beside.
void add_frame_option(CLI::App& command, std::string& frame);

/// The frame of --frame; without the option FLU of a log in the plane, as kelpie simulates such
/// logs, and FRD of six axes, as ArduSub's messages are read. Throws InputError on another name.
Frame body_frame(const std::string& name, bool six_axes);

/// The option --current of commands that learn: auto or none.
void add_current_option(CLI::App& command, PlanOptions& options);

inline constexpr const char* kUsualCurrent = "learned";

/// The option --current of commands that take a model: learned, none, or two speeds.
void add_known_current_option(CLI::App& command, std::string& current);

/// Prints to stderr the columns of a model whose unit in the log is another than the unit learned.
void tell_other_units(const TrainedModel& model, const format::ColumnUnits& learned,
                      const std::map<std::string, Unit>& units, const std::string& log);

/// Settles the current of a log for a model of velocities through the water, by the option
/// --current; without effect on other models. `is_learned`: the model learned this log. Throws
/// InputError (--current) on other text, and on a learned current for another log.
void settle_current(const std::string& wish, bool is_learned, const std::string& log,
                    TrainedModel& model);

/// The option --accept of what is refused otherwise: "implausible".
void add_accept_option(CLI::App& command, std::vector<std::string>& accept);

/// The options of a log's clock: --time and --rate.
void add_clock_options(CLI::App& command, std::string& time, double& rate_hz);

/// The option --missing (log::Roles::missing).
void add_missing_option(CLI::App& command, std::vector<std::string>& missing);

/// The option --units: columns whose values are converted to the SI.
void add_units_option(CLI::App& command, std::vector<std::string>& units);

/// The options of `kelpie identify` and `kelpie plan`.
struct IdentificationOptions : PlanOptions {
  std::optional<int> only;  ///< configuration; else the first in the log
  std::vector<std::string> thrusters;
  std::vector<std::string> thrust;  ///< known_thrusts()
};
void add_identification_options(CLI::App& command, IdentificationOptions& options);

/// The thrusts of --thrust, N per square of the thruster's unit. Throws InputError (--thrust) on
/// text without name, and on a number that is not above 0 and at most 1e9.
std::vector<std::pair<std::string, double>> known_thrusts(const std::vector<std::string>& thrust);

/// The option --pose (log::Roles::pose).
void add_pose_option(CLI::App& command, std::vector<std::string>& pose);

/// Adds the units of --units to those of a configuration. Throws InputError on text without column.
void add_units(const std::vector<std::string>& assignments,
               std::map<std::string, std::string>& units);

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
