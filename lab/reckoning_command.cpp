// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/random.hpp"
#include "lab/commands.hpp"
#include "lab/reckoning.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/learn.hpp"
#include "study/simulated_log.hpp"

namespace kelpie::lab {
namespace {

struct ReckoningArguments {
  StudiedLog log;
  std::string split = "blocks";
  std::string scenario;
  std::size_t seeds = 3;
  double current = 0.1;
  bool no_simulation = false;
  bool live = false;
  ReckoningPlan plan;
  std::string out = "out/dead-reckoning";
};

void require_planar(const log::Dataset& data) {
  const std::vector<std::string> wanted{"u", "v", "r"};
  if (data.input_names.size() < 4 ||
      !std::equal(wanted.begin(), wanted.end(), data.input_names.begin()) ||
      data.target_names.size() != 3) {
    throw InputError({.file = data.source, .line = 0, .field = "inputs"},
                     "dead reckoning needs u, v, r first, then commands, and three targets");
  }
}

ReckoningResult recorded(const ReckoningArguments& options) {
  const study::SplitSettings split = study::parse_split(options.split, 1);
  log::Dataset data = options.log.read(split.column);
  require_planar(data);
  const study::LearnPlan plan = study::plan_learning(
      std::move(data), split, ModelSettings::from_preset("default", 3), "auto");
  return options.live ? measure_live_reckoning(plan.data, options.plan)
                      : measure_reckoning(plan.data, plan.split, options.plan);
}

// The scenario's vehicle in a current from anywhere; 0: in calm water.
std::vector<simulator::LogRow> drive(simulator::Scenario scenario, std::uint64_t seed,
                                     double current, double seconds) {
  scenario.seed = seed;
  const double from = RandomStream(seed, "current").uniform(0.0, 2.0 * std::numbers::pi);
  scenario.current_m_s = {current * std::cos(from), current * std::sin(from), 0.0};
  scenario.phases.back().duration_s = seconds;
  return simulator::simulate(scenario);
}

// Learned in calm water, then in a current, the first minutes of which are for finding it.
ReckoningResult simulated(const ReckoningArguments& options, std::size_t seed) {
  constexpr double kLearningS = 1500.0;
  constexpr double kFindingS = 300.0;
  constexpr double kJudgedS = 1200.0;
  const std::string file = scenario_file(options.scenario, "small.toml");
  const simulator::Scenario scenario = simulator::read_scenario(file);
  std::vector<simulator::LogRow> rows = drive(scenario, scenario.seed + 2 * seed, 0.0, kLearningS);
  const std::size_t learned = rows.size();
  for (simulator::LogRow& row :
       drive(scenario, scenario.seed + 2 * seed + 1, options.current, kFindingS + kJudgedS)) {
    row.t_s += kLearningS;
    row.configuration = 1;
    rows.push_back(row);
  }
  const log::Table table = study::log_table(rows, file);
  const log::Dataset data = log::make_dataset(table, log::guess_roles(table, {}));
  study::Split split{.label = "learned in calm water before", .training = {}, .held_out = {}};
  for (std::size_t row = 0; row < data.rows(); ++row) {
    if (row < learned) {
      split.training.push_back(row);
    } else if (data.times_s[row] > kLearningS + kFindingS) {
      split.held_out.push_back(row);
    }
  }
  ReckoningResult result = measure_reckoning(data, split, options.plan);
  result.simulated = true;
  result.source =
      fmt::format("{}, current {:g} m/s, {} seeds", std::filesystem::path(file).filename().string(),
                  options.current, options.seeds);
  return result;
}

std::vector<ReckoningResult> measure(const ReckoningArguments& options, const ReckoningPlan& plan) {
  std::vector<ReckoningResult> results;
  ReckoningArguments mine = options;
  const std::size_t runs = options.no_simulation ? 0 : options.seeds;
  const std::size_t logs = options.log.given() ? 1 : 0;
  std::size_t done = 0;
  mine.plan.keep_going = [&](double share) {
    return plan.keep_going((static_cast<double>(done) + share) / static_cast<double>(runs + logs));
  };
  for (; done < logs; ++done) {
    results.push_back(recorded(mine));
  }
  for (std::size_t seed = 0; seed < runs && !cli::InterruptGuard::asked(); ++seed, ++done) {
    const ReckoningResult result = simulated(mine, seed);
    if (seed == 0) {
      results.push_back(result);
    } else {
      results.back().join(result);
    }
  }
  return results;
}

void reckon(const ReckoningArguments& options) {
  if (!options.log.given() && options.no_simulation) {
    throw InputError("--no-simulation", "leaves nothing to measure without a log");
  }
  run_study(
      {options.out,
       "dead_reckoning",
       "reckoning",
       {options.log.log.source.path, options.log.config, options.scenario}},
      options.plan, [&](const ReckoningPlan& plan) { return measure(options, plan); },
      [](const std::vector<ReckoningResult>& results) {
        return StudyReport{reckoning_table(results), reckoning_json(results)};
      });
}

}  // namespace

void add_reckoning(CLI::App& app) {
  const auto [command, options] = cli::add_command<ReckoningArguments>(
      app, "dead-reckoning", "Measure dead reckoning through outages of the velocity log", reckon);
  options->log.add_to(*command);
  cli::add_file(command, "--scenario", options->scenario,
                "file of the simulated vehicle; else scenarios/small.toml here, or with the "
                "program");
  add_seeds(command, options->seeds, "simulated drives, each in another current");
  command->add_option("--split", options->split, "which rows of the log are held out")
      ->capture_default_str();
  command->add_flag("--no-simulation", options->no_simulation, "the log alone");
  command->add_option("--outages", options->plan.outages_s, "their lengths [s]")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--live", options->live,
                    "the log is learned while outages pass, which lie anywhere after five minutes");
  const std::map<std::string, OutageKind> kinds{
      {"silent", OutageKind::silent}, {"zeros", OutageKind::zeros}, {"frozen", OutageKind::frozen}};
  command->add_option("--loss", options->plan.kind, "what the velocity log says in an outage")
      ->transform(CLI::CheckedTransformer(kinds));
  command->add_flag_callback(
      "--no-yaw-rate", [options = options] { options->plan.yaw_rate = false; },
      "the yaw rate falls silent, too");
  const auto add_amount = [command = command](const char* name, double& value,
                                              const char* meaning) {
    command->add_option(name, value, meaning)->check(CLI::NonNegativeNumber)->capture_default_str();
  };
  DeadReckoningSettings& settings = options->plan.settings;
  add_amount("--current", options->current, "speed of the simulated current [m/s]");
  add_amount("--practice", settings.practice_s, "length of practised outages [s]");
  add_amount("--current-before", settings.current_m_s,
             "usual current before anything is known [m/s]");
  add_amount("--current-wander", settings.current_wander, "how far the current wanders [m/s/√s]");
  cli::add_out(command, options->out, "folder for dead_reckoning.json");
}

}  // namespace kelpie::lab
