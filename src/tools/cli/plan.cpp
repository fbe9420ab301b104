// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "format/drive_files.hpp"
#include "format/settings_file.hpp"
#include "kelpie/core/error.hpp"
#include "motion/tuning.hpp"
#include "report/drive_report.hpp"
#include "study/drive_plan.hpp"
#include "study/identification.hpp"

namespace kelpie::cli {
namespace {

constexpr const char* kSetpoints = "plan.csv";
constexpr const char* kNumbers = "plan.json";
constexpr const char* kPlanPage = "plan.html";
constexpr const char* kScript = "plan.lua";

struct DriveArguments : IdentificationOptions {
  std::vector<std::string> tell;
  std::vector<std::string> apart;
  double percent = 5.0;
  double change = 20.0;
  study::DriveBounds bounds{};
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

const Actuator* actuator_of(const Alignment& alignment, const std::string& name) {
  const auto place = std::ranges::find(alignment.commands, name);
  return place == alignment.commands.end() || alignment.actuators.empty()
             ? nullptr
             : &alignment.actuators[static_cast<std::size_t>(place - alignment.commands.begin())];
}

// As far as the log went, to both sides, or as --range says in the unit of commands.
study::ThrusterRange thruster_range(const DriveArguments& options, const PlanarRows& rows,
                                    const Alignment& alignment) {
  study::ThrusterRange range;
  for (std::size_t i = 0; i < rows.thrusters.size(); ++i) {
    double most = 0.0;
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      most = std::max(most, std::abs(rows.speed(row)[i]));
    }
    range.least.push_back(-most);
    range.most.push_back(most);
  }
  for (const std::string& assignment : options.range) {
    const auto [name, text] = format::key_and_value(assignment, "--range");
    const auto place = std::ranges::find(rows.thrusters, name);
    if (place == rows.thrusters.end()) {
      throw InputError("--range", "'" + name + "' is no thruster of the log" +
                                      did_you_mean(name, rows.thrusters) + "; there are " +
                                      join_text(rows.thrusters, ", "));
    }
    const std::size_t colon = text.find(':');
    double least = number_in(text.substr(0, colon), assignment);
    double most = number_in(colon == std::string::npos ? "" : text.substr(colon + 1), assignment);
    if (const Actuator* const actuator = actuator_of(alignment, name)) {
      least = actuator->shaped(least);
      most = actuator->shaped(most);
    }
    require(least <= 0.0 && most >= 0.0 && least < most, "--range",
            "'" + assignment + "' has to be from full astern to full ahead, with rest between");
    const auto at = static_cast<std::size_t>(place - rows.thrusters.begin());
    range.least[at] = least;
    range.most[at] = most;
  }
  return range;
}

study::DriveGoal goal_of(const DriveArguments& options, const ExpectedPlanarFit& expected) {
  if (!options.apart.empty()) {
    require(options.apart.size() == 2, "--apart", "takes two causes, as in th2,drag");
    return study::parting_goal(expected, options.apart[0], options.apart[1],
                               options.change / 100.0);
  }
  const std::vector<std::pair<std::string, double>> known = known_thrusts(options.thrust);
  return study::telling_goal(expected, study::wanted_places(expected.now(), options.tell),
                             options.percent / 100.0, [known](PlanarFit& fit) {
                               if (!known.empty()) {
                                 scale_by_thrust(fit, known);
                               }
                             });
}

format::PlannedDrive planned(const DriveArguments& options) {
  const study::LearnPlan log = plan_log(options).plan;
  const study::PlanarColumns columns =
      study::planar_columns(log.data, log.settings.shared.states, options.thrusters);
  std::vector<std::size_t> all(log.data.rows());
  for (std::size_t row = 0; row < all.size(); ++row) {
    all[row] = row;
  }
  const PlanarRows rows = study::planar_rows(log.data, all, columns);
  const ExpectedPlanarFit expected =
      study::of_log(log.data, [&] { return ExpectedPlanarFit(rows); });
  const Alignment alignment = log.alignment.alignment;
  const study::DriveGoal goal = goal_of(options, expected);
  const study::PlanarPush push(expected.now().vehicle(), thruster_range(options, rows, alignment));
  format::PlannedDrive drive{.source = log.data.source, .thrusters = rows.thrusters};
  drive.plan =
      study::plan_drive(expected.now(), push, options.bounds, goal, 1.0 / log.data.rate_hz);
  drive.bounds = options.bounds;
  drive.parts = !options.apart.empty();
  drive.aim = drive.parts ? kDiagnosis.named_margin_nats : options.percent / 100.0;
  drive.has_scale = !options.thrust.empty();
  drive.command = [alignment, names = rows.thrusters](std::size_t thruster, double speed) {
    return alignment.command_for(names[thruster], speed);
  };
  return drive;
}

void run_plan(const DriveArguments& options) {
  options.answer.begin();
  known_thrusts(options.thrust);  // a mistake is told before a log is read
  if (!options.apart.empty() && !options.tell.empty()) {
    throw InputError("--apart", "and --tell are two aims: give one");
  }
  const format::PlannedDrive drive = planned(options);
  const std::vector<std::string> names{kSetpoints, kNumbers, kPlanPage, kScript};
  const file::OutFolder out = take_out_folder(options.out, names, options.files());
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
  answer.next = {"kelpie identify LOG DRIVE   (the log and the log of the drive, joined)"};
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
           "instead: two suspected causes of a change, as in th2,drag: thrusters, drag, "
           "surge_drag, sway_drag, yaw_drag, load");
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
  add_list(command, "--range", options->range,
           "commands from full astern to full ahead, NAME=LEAST:MOST; else as in the log");
  add_out(command, options->out, "folder for the setpoints, the numbers and the page");
  options->answer.add_to(*command, "the plan as JSON");
  add_examples(command, "plan dive.csv --rate 4 --tell sway_drag --seconds 60 --radius 5",
               "plan dive.csv --rate 4 --apart th2,drag");
}

}  // namespace kelpie::cli
