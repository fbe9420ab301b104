// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/six_axis_log.hpp"
#include "core/angle.hpp"
#include "core/quantile.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "format/drive_files.hpp"
#include "format/settings_file.hpp"
#include "kelpie/core/error.hpp"
#include "motion/signal_names.hpp"
#include "report/drive_report.hpp"
#include "simulator/scenario_file.hpp"
#include "study/drive_plan.hpp"
#include "study/identification.hpp"
#include "study/six_axes.hpp"
#include "vehicle/tuning.hpp"

namespace kelpie::cli {
namespace {

constexpr const char* kSetpoints = "plan.csv";
constexpr const char* kNumbers = "plan.json";
constexpr const char* kPlanPage = "plan.html";
constexpr const char* kScript = "plan.lua";

struct DriveArguments : IdentificationOptions {
  SixAxisOptions six;
  std::vector<std::string> tell;
  std::vector<std::string> apart;
  double percent = 5.0;
  double change = 20.0;
  study::DriveBounds bounds{};
  std::optional<double> depth_m{};
  std::optional<double> tilt_deg{};
  std::vector<std::string> range;
  std::string out = "out/plan";
  AnswerOptions answer;
};

double number_in(const std::string& text, const std::string& assignment) {
  double value = 0.0;
  if (!parse_number(text, value)) {
    throw InputError("--range", "'" + assignment + "' has to be NAME=LEAST:MOST, numbers");
  }
  return value;
}

// Thrusters of a log in the order of a fit, with their commands in the fit's unit.
struct DrivenThrusters {
  std::vector<std::string> names;
  const std::vector<double>& commands;  // rows × thrusters
  std::function<double(std::size_t thruster, double command)> from_log;
};

// As far as the log went, to both sides, or as --range says in the unit of commands.
study::ThrusterRange thruster_range(const DriveArguments& options,
                                    const DrivenThrusters& thrusters) {
  const std::size_t count = thrusters.names.size();
  study::ThrusterRange range{std::vector(count, 0.0), std::vector(count, 0.0)};
  for (std::size_t i = 0; i < thrusters.commands.size(); ++i) {
    double& most = range.most[i % count];
    most = std::max(most, std::abs(thrusters.commands[i]));
    range.least[i % count] = -most;
  }
  for (const std::string& assignment : options.range) {
    const auto [name, text] = format::key_and_value(assignment, "--range");
    const std::size_t at = require_name("--range", name, "thruster", thrusters.names);
    const std::size_t colon = text.find(':');
    const double least = thrusters.from_log(at, number_in(text.substr(0, colon), assignment));
    const double most = thrusters.from_log(
        at, number_in(colon == std::string::npos ? "" : text.substr(colon + 1), assignment));
    require(least <= 0.0 && most >= 0.0 && least < most, "--range",
            "'" + assignment + "' has to be from full astern to full ahead, with rest between");
    range.least[at] = least;
    range.most[at] = most;
  }
  return range;
}

double shaped(const Alignment& alignment, const std::string& name, double command) {
  const auto place = std::ranges::find(alignment.commands, name);
  return place == alignment.commands.end() || alignment.actuators.empty()
             ? command
             : alignment.actuators[static_cast<std::size_t>(place - alignment.commands.begin())]
                   .shaped(command);
}

study::DriveGoal goal_of(const DriveArguments& options, const ExpectedFit& expected,
                         const std::vector<std::pair<std::string, double>>& known) {
  if (!options.apart.empty()) {
    require(options.apart.size() == 2, "--apart", "takes two causes, as in th2,drag");
    return study::parting_goal(expected, options.apart[0], options.apart[1],
                               options.change / 100.0);
  }
  return study::telling_goal(expected, study::wanted_places(expected.now(), options.tell),
                             options.percent / 100.0, [known](ParameterFit& fit) {
                               if (!known.empty()) {
                                 scale_by_thrust(fit, known);
                               }
                             });
}

// All rows of one configuration: a plan needs no held-out rows, but one vehicle.
std::vector<std::size_t> rows_of_vehicle(const log::Dataset& data, std::optional<int> only) {
  study::Split all{};
  all.training.resize(data.rows());
  std::iota(all.training.begin(), all.training.end(), std::size_t{0});
  return study::training_rows(data, all, only);
}

// The plan for a vehicle, with what its files say.
format::PlannedDrive planned_for(const DriveArguments& options,
                                 const study::DrivableVehicle& vehicle,
                                 const study::DriveGoal& goal, const log::Dataset& data,
                                 const DrivenThrusters& thrusters) {
  format::PlannedDrive drive{.source = data.source, .thrusters = thrusters.names};
  drive.bounds = options.bounds;
  drive.plan = study::plan_drive(vehicle, drive.bounds, goal);
  drive.parts = !options.apart.empty();
  drive.aim = drive.parts ? kDiagnosis.named_margin_nats : options.percent / 100.0;
  drive.has_scale = !options.thrust.empty();
  return drive;
}

format::PlannedDrive planned_in_plane(const DriveArguments& options) {
  refuse_volts_in_plane(options.six);
  require(!options.depth_m, "--depth", "bounds a drive on six axes, which takes --vehicle");
  require(!options.tilt_deg, "--tilt", "bounds a drive on six axes, which takes --vehicle");
  const study::LearnPlan log = plan_log(options).plan;
  const study::PlanarColumns columns =
      study::planar_columns(log.data, log.settings.shared.states, options.thrusters);
  const PlanarRows rows =
      study::planar_rows(log.data, rows_of_vehicle(log.data, options.only), columns);
  const ExpectedPlanarFit expected =
      study::of_log(log.data, [&] { return ExpectedPlanarFit(rows); });
  const Alignment& alignment = log.alignment.alignment;
  const DrivenThrusters thrusters{rows.thrusters, rows.speeds,
                                  [&](std::size_t thruster, double command) {
                                    return shaped(alignment, rows.thrusters[thruster], command);
                                  }};
  const study::DriveGoal goal = goal_of(options, expected, known_thrusts(options.thrust));
  const study::DrivablePlanarVehicle vehicle(expected, thruster_range(options, thrusters),
                                             1.0 / log.data.rate_hz);
  format::PlannedDrive drive = planned_for(options, vehicle, goal, log.data, thrusters);
  drive.command = [alignment, names = rows.thrusters](std::size_t thruster, double speed) {
    return alignment.command_for(names[thruster], speed);
  };
  return drive;
}

format::PlannedDrive planned_on_six_axes(const DriveArguments& options,
                                         const simulator::VehicleParameters& file) {
  std::string why;
  const std::optional<SixAxisLog> log = six_axis_log(options, options.six, file, why);
  if (!log) {
    throw InputError("--vehicle", "is of six axes, and the log has " + why);
  }
  const log::Dataset& data = log->plan.data;
  const SixAxisRows rows = study::six_axis_rows(data, rows_of_vehicle(data, options.only),
                                                log->columns, file, log->frame, log->neutral);
  const ExpectedSixAxisFit expected =
      study::of_log(data, [&] { return ExpectedSixAxisFit(rows, log->how); });
  DrivenThrusters thrusters{{}, rows.commands, [&](std::size_t thruster, double command) {
                              return study::command_share(file, thruster, command, kNeutralPulseUs);
                            }};
  for (const PlacedThruster& thruster : rows.thrusters) {
    thrusters.names.push_back(thruster.name);
  }
  const study::DriveGoal goal =
      goal_of(options, expected, of_full_commands(known_thrusts(options.thrust), file));
  std::vector<double> volts = rows.volts;
  const double volts_ratio = volts.empty() ? 1.0 : quantile(volts, 0.5) / rows.nominal_volts;
  const study::DrivableSixAxisVehicle vehicle(expected, thruster_range(options, thrusters),
                                              volts_ratio);
  DriveArguments with_bounds = options;
  with_bounds.bounds.depth_m = options.depth_m.value_or(options.bounds.depth_m);
  with_bounds.bounds.tilt_rad =
      options.tilt_deg ? *options.tilt_deg * kRadPerDegree : options.bounds.tilt_rad;
  format::PlannedDrive drive = planned_for(with_bounds, vehicle, goal, data, thrusters);
  drive.six_axes = true;
  drive.has_scale = true;  // the vehicle file's surge inertia
  drive.command = [file, neutral = log->neutral, names = thrusters.names,
                   alignment = log->plan.alignment.alignment](std::size_t thruster, double share) {
    return alignment.command_for(names[thruster],
                                 study::command_for_share(file, thruster, share, neutral));
  };
  return drive;
}

format::PlannedDrive planned(const DriveArguments& options) {
  if (!options.six.vehicle.empty()) {
    const simulator::VehicleParameters file = simulator::read_vehicle(options.six.vehicle);
    if (!simulator::drives_in_plane(file)) {
      return planned_on_six_axes(options, file);
    }
  }
  return planned_in_plane(options);
}

// The log joined with that of the drive, read alike; --since is a time of one log.
std::string next_text(const DriveArguments& options) {
  DriveArguments joined = options;
  joined.since_s.reset();
  return fmt::format("kelpie identify {} DRIVE{}   (the log and the log of the drive, joined)",
                     joined.logs_text(), identification_text(joined, joined.six));
}

void run_plan(const DriveArguments& given) {
  given.answer.begin();
  DriveArguments options = given;
  begin_six_axes(options.six, options);
  known_thrusts(options.thrust);  // a mistake is told before a log is read
  if (!options.apart.empty() && !options.tell.empty()) {
    throw InputError("--apart", "and --tell are two aims: give one");
  }
  const std::vector<std::string> names{kSetpoints, kNumbers, kPlanPage, kScript};
  std::vector<std::string> inputs = options.files();
  inputs.push_back(options.six.vehicle);
  const file::OutFolder out = take_out_folder(options.out, names, inputs);
  const format::PlannedDrive drive = planned(options);
  file::FileSet files{{kSetpoints, format::drive_csv(drive)},
                      {kNumbers, format::drive_json(drive)},
                      {kPlanPage, report::drive_html(drive)},
                      {kScript, std::nullopt}};
  if (format::has_pulses(drive)) {
    files[kScript] = format::drive_lua(drive);
  }
  file::write_files_whole(out.path(), files);
  Answer answer{.verdict = report::drive_verdict(drive),
                .tables = report::drive_tables(drive),
                .document = options.answer.json ? format::drive_json(drive) : "",
                .files = {},
                .next = {}};
  answer.add_files(files, out.path(), {{kSetpoints, "setpoints"}});
  answer.next = {next_text(given)};
  give(answer, options.answer);
}

}  // namespace

void add_plan(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "plan", "Choose what to drive next, so that a log tells the vehicle's parameters",
      run_plan);
  add_identification_options(*command, *options);
  add_list(command, "--tell", options->tell,
           "parameters of `kelpie identify`, or words of them, as in sway_drag,th1; else all "
           "masses, drags, thrusts and arms");
  command->add_option("--percent", options->percent, "wanted half width of the 90 % intervals")
      ->check(within(0.1, 100.0))
      ->capture_default_str();
  add_list(command, "--apart", options->apart,
           "instead: two suspected causes of a change, as in th2,drag: thrusters, "
           "all_thrusters, drag, surge_drag, sway_drag, yaw_drag, load, surge_force, "
           "sway_force, yaw_moment");
  command->add_option("--change", options->change, "suspected size of the change in %")
      ->check(within(1.0, 100.0))
      ->capture_default_str();
  command->add_option("--seconds", options->bounds.time_s, "longest drive [s]")
      ->check(within(5.0, 3600.0))
      ->capture_default_str();
  command->add_option("--speed", options->bounds.speed_m_s, "greatest speed [m/s]")
      ->check(within(0.01, 100.0))
      ->capture_default_str();
  command->add_option("--radius", options->bounds.radius_m, "greatest distance from the start [m]")
      ->check(within(0.1, 1e5))
      ->capture_default_str();
  add_file(command, "--vehicle", options->six.vehicle,
           "vehicle file with the places of the log's thrusters: all six axes are planned, else "
           "the plane");
  command->add_option("--volts", options->six.volts,
                      "column with the supply of the thrusters in V, for six axes; the drive is "
                      "planned at its median");
  add_frame_option(*command, options->six.frame);
  command
      ->add_option("--depth", options->depth_m, "greatest change of depth [m], on six axes; else 2")
      ->check(within(0.1, 1e4));
  command
      ->add_option("--tilt", options->tilt_deg,
                   "greatest roll or pitch [degrees], on six axes; else 30")
      ->check(within(1.0, 80.0));
  add_list(command, "--range", options->range,
           "commands from full astern to full ahead, NAME=LEAST:MOST; else as in the log");
  add_out(command, options->out, "folder for the setpoints, the numbers and the page");
  options->answer.add_to(*command, "the plan as JSON");
  add_examples(command, "plan dive.csv --rate 4 --tell sway_drag --seconds 60 --radius 5",
               "plan dive.BIN --vehicle vehicles/bluerov2_heavy.toml --tell heave_drag --depth 3");
}

}  // namespace kelpie::cli
