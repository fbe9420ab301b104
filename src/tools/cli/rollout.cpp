// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "format/learned_logs.hpp"
#include "format/rollout_json.hpp"
#include "format/settings_file.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/trained_model.hpp"
#include "log/dataset.hpp"
#include "model/snapshot.hpp"
#include "report/rollout_report.hpp"
#include "report/verdicts.hpp"
#include "study/alignment.hpp"
#include "study/open_loop_study.hpp"
#include "study/split.hpp"

namespace kelpie::cli {
namespace {

struct RolloutArguments {
  LogOptions log;
  std::string config;
  std::string model;
  std::vector<std::string> start;
  std::string split = "auto";
  std::uint64_t seed = 1;
  std::vector<double> horizons{1.0, 5.0, 10.0, 40.0};
  std::string commands = "linear";
  double step_s = RolloutSettings{}.step_s;
  std::string current;
  std::string out = "out/rollout";
  AnswerOptions answer;
};

std::vector<std::string> state_names(const TrainedModel& model, const OpenLoop& loop) {
  std::vector<std::string> names;
  names.reserve(loop.states.size());
  for (const std::size_t state : loop.states) {
    names.push_back(model.input_names[state]);
  }
  return names;
}

RolloutSettings rollout_settings(const RolloutArguments& options) {
  RolloutSettings settings;
  settings.step_s = options.step_s;
  settings.between = options.commands == "held" ? CommandPath::held : CommandPath::linear;
  return settings;
}

log::Log read_with_inputs(const RolloutArguments& options, const TrainedModel& model,
                          const std::vector<std::string>& targets, const std::string& held_out) {
  const log::LogConfig config = log::read_log_config(options.config);
  const auto require_same = [](const char* option, const std::vector<std::string>& given,
                               const std::vector<std::string>& known) {
    require(given.empty() || given == known, option,
            "are those of the model: " + join_text(known, ","));
  };
  require_same("--inputs", options.log.inputs, model.input_names);
  require_same("--targets", options.log.targets, model.target_names());
  log::Roles wanted = options.log.over(config.roles);
  wanted.inputs = model.input_names;
  wanted.targets = targets;
  wanted.held_out = held_out;
  if (!targets.empty() && options.current != "none") {
    wanted.heading = model.alignment.water.heading;
  }
  return open_log(options.log.source, config, wanted);
}

log::Dataset read_judged_log(const RolloutArguments& options, const TrainedModel& model) {
  std::vector<std::string> targets;
  targets.reserve(model.axes.size());
  for (const TrainedModel::Axis& axis : model.axes) {
    targets.push_back(axis.name);
  }
  const std::string held_out = study::parse_split(options.split, options.seed).column;
  return read_with_inputs(options, model, targets, held_out).dataset();
}

void say_shift(const TrainedModel& model, const log::Dataset& data) {
  if (!model.alignment.none()) {
    say("{}, as when the model was learned\n", model.alignment.text(data.rate_hz));
  }
}

file::OutFolder take_folder(const RolloutArguments& options,
                            const std::vector<std::string>& names) {
  return take_out_folder(options.out, names,
                         {options.log.source.path, options.model, options.config});
}

study::OpenLoopResult judge(const RolloutArguments& options, const TrainedModel& model,
                            const format::ColumnUnits& learned, const OpenLoop& loop,
                            const log::Dataset& data) {
  const study::Split split =
      study::make_split(data, study::parse_split(options.split, options.seed));
  study::require_held_out(split);
  const std::vector<study::Stretch> stretches =
      study::unbroken_stretches(data, split.held_out, loop.states);
  study::OpenLoopStudy study;
  study.horizons_s = options.horizons;
  std::ranges::sort(study.horizons_s);
  study.rollout = rollout_settings(options);

  study::OpenLoopResult result;
  result.source = data.source;
  result.model = options.model;
  result.split = "held out: " + split.label;
  result.rows = split.held_out.size();
  result.stretches = stretches.size();
  result.held = study.rollout.between == CommandPath::held;
  result.states = state_names(model, loop);
  // The log's own where it has any: those of the model are of the log that was learned.
  for (const std::string& state : result.states) {
    const auto own = data.units.find(state);
    const auto known = learned.find(state);
    result.units.push_back(own != data.units.end()  ? own->second.text()
                           : known != learned.end() ? known->second
                                                    : "");
  }

  const std::vector<study::OpenLoopContender> contenders =
      study::open_loop_contenders(model, loop, data, split);
  ProgressBar progress("rolling out");
  const InterruptGuard guard;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    study.keep_going = [&](double share) {
      progress.at((static_cast<double>(i) + share) / static_cast<double>(contenders.size()));
      return !InterruptGuard::asked();
    };
    result.scores.push_back(
        study::score_open_loop(contenders[i].name, contenders[i].loop, data, stretches, study));
  }
  if (InterruptGuard::asked()) {
    throw Failure("interrupted; nothing was written");
  }
  study::add_example(result, loop, data, stretches, study);
  return result;
}

void write_judgement(const RolloutArguments& options, const study::OpenLoopResult& result) {
  const std::filesystem::path folder = options.out;
  file::FileSet files{{"result.json", format::rollout_json(result)},
                      {"report.html", report::rollout_html(result)},
                      {"example.csv", std::nullopt}};
  if (!result.example.time_s.empty()) {
    files["example.csv"] = log::csv_text(format::trajectory_table(result.example, result.states));
  }
  file::write_files_whole(folder, files);
  Answer answer{.verdict = report::rollout_verdict(result),
                .tables = report::rollout_table(result),
                .document = *files["result.json"],
                .files = {{"result", (folder / "result.json").string()},
                          {"report", (folder / "report.html").string()}},
                .next = {fmt::format("kelpie export {} --c model.c", shell_word(options.model))}};
  if (files["example.csv"]) {
    answer.files.emplace_back("example", (folder / "example.csv").string());
  }
  give(answer, options.answer);
}

// The velocities of --start by name.
std::map<std::string, double> start_velocities(const RolloutArguments& options,
                                               const std::vector<std::string>& names) {
  std::map<std::string, double> velocities;
  for (const std::string& assignment : options.start) {
    const auto [name, text] = format::key_and_value(assignment, "--start");
    require_name("--start", name, "velocity of the model", names);
    if (!parse_number(text, velocities[name]) || !std::isfinite(velocities[name])) {
      throw InputError("--start " + name, "'" + text + "' is not a finite number");
    }
  }
  for (const std::string& name : names) {
    if (!velocities.contains(name)) {
      throw InputError("--start", "doesn't say '" + name + "'; all of " + join_text(names, ", ") +
                                      " are needed");
    }
  }
  return velocities;
}

// Options that judge have nothing to do where commands are followed.
void refuse_judging(const RolloutArguments& options) {
  const RolloutArguments usual;
  const auto given = std::to_array<std::pair<const char*, bool>>(
      {{"--horizons", options.horizons != usual.horizons},
       {"--split", options.split != usual.split},
       {"--seed", options.seed != usual.seed},
       {"--current", options.current != kUsualCurrent},
       {"--verbose", options.answer.verbose},
       {"--json", options.answer.json}});
  for (const auto& [option, is_given] : given) {
    require(!is_given, option,
            "belongs to the judgement of a log; with --start the log holds commands, and "
            "rollout.csv has what comes of them");
  }
}

void roll_commands(const RolloutArguments& options, const TrainedModel& model,
                   const format::ColumnUnits& learned, const OpenLoop& loop) {
  Alignment alignment = model.alignment;
  alignment.water = {};  // velocities of --start are through the water
  const log::Log log = read_with_inputs(options, model, {}, {});
  tell_other_units(model, learned, log::column_units(log.table, log.roles),
                   options.log.source.path);
  const log::Dataset data = study::aligned(
      log::make_commands(log.table, log.roles, start_velocities(options, state_names(model, loop))),
      alignment);
  say_shift(model, data);
  const file::OutFolder folder = take_folder(options, {"rollout.csv"});
  study::Trajectory path =
      study::roll_out(loop, data, 0, data.rows() - 1, rollout_settings(options));
  for (std::vector<double>& measured : path.measured) {
    measured.clear();
  }
  const std::filesystem::path file = std::filesystem::path(options.out) / "rollout.csv";
  file::write_files_whole(
      options.out,
      {{"rollout.csv", log::csv_text(format::trajectory_table(path, state_names(model, loop)))}});
  const auto outside = std::ranges::count(path.beyond, true);
  say("{} rows rolled out, {} of them beyond known ground\nrollout: {}\n", data.rows(), outside,
      file.string());
}

void roll(const RolloutArguments& options, TrainedModel& model, const format::ModelInfo& info) {
  const OpenLoop loop = open_loop(model);
  if (options.start.empty()) {
    log::Dataset read = read_judged_log(options, model);
    tell_other_units(model, info.units, read.units, options.log.source.path);
    settle_current(options.current, !format::held_out_rows(info.learned, read).empty(),
                   options.log.source.path, model);
    const log::Dataset data = study::aligned(std::move(read), model.alignment);
    say_shift(model, data);
    const file::OutFolder folder =
        take_folder(options, {"result.json", "report.html", "example.csv"});
    write_judgement(options, judge(options, model, info.units, loop, data));
  } else {
    roll_commands(options, model, info.units, loop);
  }
}

void rollout(const RolloutArguments& options) {
  options.answer.begin();
  if (!options.start.empty()) {
    refuse_judging(options);
  }
  constexpr std::size_t kMostHorizons = 100;
  require(options.horizons.size() <= kMostHorizons, "--horizons", "are at most 100");
  with_given_model(options.model, [&](TrainedModel& model, const format::ModelInfo& info) {
    roll(options, model, info);
  });
}

}  // namespace

void add_rollout(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "rollout",
      "Integrate a learned model in open loop: judge it on a log, or follow commands", rollout);
  options->log.add_to(*command);
  add_file(command, "--config", options->config, "TOML file that says what signals to take");
  add_model(command, "--model", options->model);
  add_list(command, "--start", options->start,
           "velocities to start from, as in u=0.5,v=0,r=0: the log then holds the commands, "
           "and what comes of them is written");
  add_split_option(*command, options->split,
                   "as given to `kelpie learn`: rollouts start in the rows it held out");
  add_seed(command, options->seed);
  constexpr double kShortestS = 0.001;
  constexpr double kDayS = 86'400.0;
  command->add_option("--horizons", options->horizons, "seconds after the start")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(within(kShortestS, kDayS))
      ->capture_default_str();
  add_known_current_option(*command, options->current);
  command
      ->add_option("--commands", options->commands,
                   "between two rows: linear (measured speeds) or held (commands)")
      ->check(CLI::IsMember({"linear", "held"}))
      ->capture_default_str();
  command->add_option("--step", options->step_s, "longest step of the integrator [s]")
      ->check(within(kShortestS, 60.0))
      ->capture_default_str();
  add_out(command, options->out, "folder for the results");
  options->answer.add_to(*command, "result.json");
  add_examples(command, "rollout dive.csv --rate 4 --horizons 1,10,60",
               "rollout commands.csv --start u=0.5,v=0,r=0");
}

}  // namespace kelpie::cli
