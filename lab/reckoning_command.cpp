// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "lab/commands.hpp"
#include "lab/reckoning_report.hpp"
#include "lab/report_run.hpp"
#include "lab/scenario_folder.hpp"
#include "study/simulated_log.hpp"
#include "vehicle/scenario_file.hpp"
#include "vehicle/simulation.hpp"

namespace kelpie::lab {
namespace {

struct ReckoningArguments {
  cli::LogOptions log;
  std::string config;
  std::string split = "blocks";
  std::string scenario;
  std::size_t seeds = 3;
  double current = 0.1;
  bool no_simulation = false;
  std::vector<double> outages{10.0, 30.0, 60.0, 120.0};
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
  const log::LogConfig config = log::read_log_config(options.config);
  const study::SplitSettings split = study::parse_split(options.split, 1);
  log::Roles roles = options.log.over(config.roles);
  roles.held_out = split.column;
  const log::Dataset data = cli::open_log(options.log.source, config, roles).dataset();
  require_planar(data);
  return measure_reckoning(data, study::make_split(data, split), options.plan);
}

// The scenario's vehicle in a current from anywhere; 0: in calm water.
std::vector<vehicle::LogRow> drive(vehicle::Scenario scenario, std::uint64_t seed, double current,
                                   double seconds) {
  scenario.seed = seed;
  const double from = RandomStream(seed, "current").uniform(0.0, 2.0 * std::numbers::pi);
  scenario.current_m_s = {current * std::cos(from), current * std::sin(from), 0.0};
  scenario.phases.back().duration_s = seconds;
  return vehicle::simulate(scenario);
}

// Learned in calm water, then in a current, the first minutes of which are for finding it.
ReckoningResult simulated(const ReckoningArguments& options, std::size_t seed) {
  constexpr double kLearningS = 1500.0;
  constexpr double kFindingS = 300.0;
  constexpr double kJudgedS = 1200.0;
  const std::string file =
      options.scenario.empty() ? (scenario_folder() / "small.toml").string() : options.scenario;
  const vehicle::Scenario scenario = vehicle::read_scenario(file);
  std::vector<vehicle::LogRow> rows = drive(scenario, scenario.seed + 2 * seed, 0.0, kLearningS);
  const std::size_t learned = rows.size();
  for (vehicle::LogRow& row :
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

std::vector<ReckoningResult> measure(const ReckoningArguments& options,
                                     const std::function<bool(double)>& keep_going) {
  std::vector<ReckoningResult> results;
  ReckoningArguments mine = options;
  mine.plan.outages_s = options.outages;
  const std::size_t runs = options.no_simulation ? 0 : options.seeds;
  const bool log = !options.log.source.path.empty();
  std::size_t done = 0;
  mine.plan.keep_going = [&](double share) {
    return keep_going((static_cast<double>(done) + share) /
                      static_cast<double>(runs + (log ? 1 : 0)));
  };
  if (log) {
    results.push_back(recorded(mine));
    ++done;
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
  if (options.log.source.path.empty() && options.no_simulation) {
    throw InputError("--no-simulation", "leaves nothing to measure without a log");
  }
  const file::OutFolder folder = take_report_folder(
      options.out, "dead_reckoning", {options.log.source.path, options.config, options.scenario});
  const auto results = run_watched(
      "reckoning", [&](const auto& keep_going) { return measure(options, keep_going); });
  write_report(folder, "dead_reckoning", {reckoning_table(results), reckoning_json(results)});
}

}  // namespace

void add_reckoning(CLI::App& app) {
  auto options = std::make_shared<ReckoningArguments>();
  CLI::App* const command = app.add_subcommand(
      "dead-reckoning", "Measure dead reckoning through outages of the velocity log");
  options->log.add_to(*command);
  command->get_option("log")->required(false);
  command
      ->add_option("--config", options->config,
                   "TOML file whose [log] says what the log's columns are")
      ->type_name("FILE");
  command->add_option("--split", options->split, "which rows of the log are held out")
      ->capture_default_str();
  command
      ->add_option("--scenario", options->scenario,
                   "file of the simulated vehicle; else scenarios/small.toml here, or with the "
                   "program")
      ->type_name("FILE");
  command->add_option("--seeds", options->seeds, "simulated drives, each in another current")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--current", options->current, "speed of the simulated current [m/s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--no-simulation", options->no_simulation, "the log alone");
  command->add_option("--outages", options->outages, "their lengths [s]")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag_callback(
      "--no-yaw-rate", [options] { options->plan.yaw_rate = false; },
      "the yaw rate falls silent, too");
  command
      ->add_option("--practice", options->plan.settings.practice_s,
                   "length of practised outages [s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--current-before", options->plan.settings.current_m_s,
                   "usual current before anything is known [m/s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--current-wander", options->plan.settings.current_wander,
                   "how far the current wanders [m/s/√s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--out", options->out, "folder for dead_reckoning.json")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options] { reckon(*options); });
}

}  // namespace kelpie::lab
