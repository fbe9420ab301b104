// SPDX-License-Identifier: Apache-2.0

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "log/csv.hpp"
#include "study/simulated_log.hpp"
#include "vehicle/scenario_file.hpp"
#include "vehicle/simulation.hpp"

namespace kelpie::cli {
namespace {

struct SimulateArguments {
  std::string scenario;
  std::string out;
  std::optional<std::uint64_t> seed;
};

void run_simulate(const SimulateArguments& options) {
  check_output("--out", options.out, {options.scenario});
  vehicle::Scenario scenario = vehicle::read_scenario(options.scenario);
  scenario.seed = options.seed.value_or(scenario.seed);
  ProgressBar bar("simulating");
  const std::vector<vehicle::LogRow> rows =
      vehicle::simulate(scenario, [&](double share) { bar.at(share); });
  log::write_csv(options.out, study::log_table(rows, options.scenario));
  say("{}: {} rows, {} s at {} Hz, seed {}\n", options.out, rows.size(), scenario.duration_s(),
      scenario.rate_hz, scenario.seed);
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto options = std::make_shared<SimulateArguments>();
  CLI::App* const command =
      app.add_subcommand("simulate", "Drive a simulated vehicle and write its log");
  command->add_option("scenario", options->scenario, "Scenario file (scenarios/*.toml)")
      ->required()
      ->type_name("FILE");
  command->add_option("--out", options->out, "CSV file to write")->required()->type_name("FILE");
  command->add_option("--seed", options->seed, "Instead of the scenario's seed")
      ->check(CLI::NonNegativeNumber);
  command->callback([options] { run_simulate(*options); });
}

}  // namespace kelpie::cli
