// SPDX-License-Identifier: Apache-2.0

#include <optional>
#include <string>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "log/dataset.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"

namespace kelpie::cli {
namespace {

struct SimulateArguments {
  std::string scenario;
  std::string out;
  std::optional<std::uint64_t> seed;
};

void run_simulate(const SimulateArguments& options) {
  check_output("--out", options.out, {options.scenario});
  simulator::Scenario scenario = simulator::read_scenario(options.scenario);
  scenario.seed = options.seed.value_or(scenario.seed);
  ProgressBar bar("simulating");
  const simulator::Progress progress = [&](double share) { bar.at(share); };
  const log::Table table = in_file(options.scenario, [&] {
    return scenario.log == simulator::LogKind::six
               ? study::log_table(simulator::simulate_six_axes(scenario, progress),
                                  scenario.vehicle, options.scenario)
               : study::log_table(simulator::simulate(scenario, progress), options.scenario);
  });
  log::write_csv(options.out, table);
  say("{}: {} rows, {} s at {} Hz, seed {}\n", options.out, table.rows(), scenario.duration_s(),
      scenario.rate_hz, scenario.seed);
}

}  // namespace

void add_simulate(CLI::App& app) {
  const auto [command, options] =
      add_command(app, "simulate", "Drive a simulated vehicle and write its log", run_simulate);
  add_file(command, "scenario", options->scenario, "Scenario file (scenarios/*.toml)")->required();
  add_file(command, "--out", options->out, "CSV file to write")->required();
  command->add_option("--seed", options->seed, "Instead of the scenario's seed");
  add_examples(command, "simulate scenarios/diagnosis.toml --out damaged.csv",
               "simulate scenarios/bluerov2_heavy.toml --out six_axes.csv --seed 2");
}

}  // namespace kelpie::cli
