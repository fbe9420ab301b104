// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "cli/progress.hpp"
#include "kelpie/core/error.hpp"
#include "lab/bench.hpp"
#include "lab/bench_report.hpp"
#include "lab/commands.hpp"
#include "lab/report_run.hpp"
#include "lab/scenario_folder.hpp"
#include "lab/soak.hpp"
#include "study/simulated_log.hpp"
#include "vehicle/scenario_file.hpp"

namespace kelpie::lab {
namespace {

struct BenchArguments {
  cli::LogOptions log;
  std::string config;
  std::string scenario;
  bool quick = false;
  std::optional<std::size_t> window;
  std::size_t soak = 0;
  std::size_t updates = 0;
  double budget_ms = 0.0;
  std::string out = "out/bench";
};

BenchStream recorded(const BenchArguments& options) {
  const log::LogConfig config = log::read_log_config(options.config);
  return {cli::open_log(options.log.source, config, options.log.over(config.roles)).dataset(),
          false};
}

BenchStream simulated(const std::string& file) {
  const vehicle::Scenario scenario = vehicle::read_scenario(file);
  const log::Table table = study::log_table(vehicle::simulate(scenario), file);
  return {log::make_dataset(table, log::guess_roles(table, {})), true};
}

BenchResult measure(const BenchArguments& options) {
  BenchPlan plan = options.quick ? quick_bench() : BenchPlan{};
  plan.window = options.window.value_or(plan.window);
  std::vector<BenchStream> streams;
  if (!options.log.source.path.empty()) {
    streams.push_back(recorded(options));
  }
  streams.push_back(simulated(options.scenario.empty() ? (scenario_folder() / "paper.toml").string()
                                                       : options.scenario));
  return run_watched("measuring", [&](const auto& keep_going) {
    plan.keep_going = keep_going;
    return run_bench(streams, plan);
  });
}

void bench(const BenchArguments& options) {
  const file::OutFolder folder = take_report_folder(
      options.out, "bench", {options.log.source.path, options.config, options.scenario});
  const BenchResult result = measure(options);
  write_report(folder, "bench", {bench_table(result), bench_json(result)});
}

void soak(std::size_t updates) {
  SoakPlan plan;
  plan.updates = updates;
  const cli::InterruptGuard guard;
  std::vector<SoakRun> runs;
  {
    cli::ProgressBar progress("soaking");
    plan.keep_going = [&](std::size_t done) {
      progress.at(0.5 * static_cast<double>(done) / static_cast<double>(updates));
      return !cli::InterruptGuard::asked();
    };
    runs = run_soak(plan);
  }
  fmt::print("{}", soak_table(runs));
  for (const SoakRun& run : runs) {
    if (!run.good()) {
      throw Failure("the solver did not keep to what it promises");
    }
  }
}

void time_updates(const BenchArguments& options) {
  TimesPlan plan{.updates = options.updates, .budget_us = 1e3 * options.budget_ms};
  const cli::InterruptGuard guard;
  UpdateTimes times;
  {
    cli::ProgressBar progress("driving");
    plan.keep_going = [&](std::size_t done) {
      progress.at(static_cast<double>(done) / static_cast<double>(options.updates));
      return !cli::InterruptGuard::asked();
    };
    times = measure_update_times(plan);
  }
  fmt::print("{}", times_table(times));
}

void run_bench(const BenchArguments& options) {
  if (options.soak > 0) {
    soak(options.soak);
  } else if (options.updates > 0) {
    time_updates(options);
  } else {
    bench(options);
  }
}

}  // namespace

void add_bench(CLI::App& app) {
  auto options = std::make_shared<BenchArguments>();
  CLI::App* const command =
      app.add_subcommand("bench", "Measure how long updates take, solvers side by side");
  options->log.add_to(*command);
  command
      ->add_option("--config", options->config,
                   "TOML file whose [log] says what the log's columns are")
      ->type_name("FILE");
  command->get_option("log")->required(false);
  command
      ->add_option(
          "--scenario", options->scenario,
          "file of the simulated stream beside the log; else scenarios/paper.toml here, or "
          "with the program")
      ->type_name("FILE");
  command->add_flag("--quick", options->quick, "fewer updates and sizes");
  command->add_option("--window", options->window, "samples in the window, 900 unless given")
      ->check(CLI::Range(10, 20'000));
  command->add_option("--out", options->out, "folder for bench.json")
      ->capture_default_str()
      ->type_name("FOLDER");
  command
      ->add_option("--soak", options->soak,
                   "instead, keep the path solver at it for so many updates and check it")
      ->check(CLI::PositiveNumber);
  CLI::Option* const updates =
      command
          ->add_option("--updates", options->updates,
                       "instead, time so many single updates of a model with three axes, to which "
                       "twenty changes and as many new scales happen")
          ->check(CLI::PositiveNumber);
  command
      ->add_option("--budget", options->budget_ms, "of each of these updates, in ms of its thread")
      ->check(CLI::PositiveNumber)
      ->needs(updates);
  command->callback([options] { run_bench(*options); });
}

}  // namespace kelpie::lab
