// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "lab/bench.hpp"
#include "lab/commands.hpp"
#include "vehicle/scenario_file.hpp"

namespace kelpie::lab {
namespace {

struct BenchArguments {
  StudiedLog log;
  std::string scenario;
  bool quick = false;
  std::optional<std::size_t> window;
  std::size_t soak = 0;
  std::size_t updates = 0;
  double budget_ms = 0.0;
  std::string out = "out/bench";
};

void bench_streams(const BenchArguments& options) {
  BenchPlan plan = options.quick ? quick_bench() : BenchPlan{};
  plan.window = options.window.value_or(plan.window);
  const auto study = [&](const BenchPlan& watched) {
    std::vector<BenchStream> streams;
    if (options.log.given()) {
      streams.push_back({options.log.read(), false});
    }
    const std::string file = scenario_file(options.scenario, "paper.toml");
    streams.push_back({simulated_log(vehicle::read_scenario(file), file), true});
    return run_bench(streams, watched);
  };
  run_study({options.out,
             "bench",
             "measuring",
             {options.log.log.source.path, options.log.config, options.scenario}},
            plan, study, [](const BenchResult& result) {
              return StudyReport{bench_table(result), bench_json(result)};
            });
}

void soak(std::size_t updates) {
  const std::vector<SoakRun> runs = run_watched(
      "soaking",
      [&](const auto& keep_going) {
        return run_soak({.updates = updates, .keep_going = [&](std::size_t done) {
                           return keep_going(0.5 * static_cast<double>(done) /
                                             static_cast<double>(updates));
                         }});
      },
      true);
  fmt::print("{}", soak_table(runs));
  if (!std::ranges::all_of(runs, &SoakRun::good)) {
    throw Failure("the solver did not keep to what it promises");
  }
}

void time_updates(const BenchArguments& options) {
  const UpdateTimes times = run_watched(
      "driving",
      [&](const auto& keep_going) {
        return measure_update_times({.updates = options.updates,
                                     .budget_us = 1e3 * options.budget_ms,
                                     .keep_going = [&](std::size_t done) {
                                       return keep_going(static_cast<double>(done) /
                                                         static_cast<double>(options.updates));
                                     }});
      },
      true);
  fmt::print("{}", times_table(times));
}

void bench(const BenchArguments& options) {
  if (options.soak > 0) {
    soak(options.soak);
  } else if (options.updates > 0) {
    time_updates(options);
  } else {
    bench_streams(options);
  }
}

}  // namespace

void add_bench(CLI::App& app) {
  const auto [command, options] = cli::add_command<BenchArguments>(
      app, "bench", "Measure how long updates take, solvers side by side", bench);
  options->log.add_to(*command);
  cli::add_file(command, "--scenario", options->scenario,
                "file of the simulated stream beside the log; else scenarios/paper.toml here, or "
                "with the program");
  command->add_flag("--quick", options->quick, "fewer updates and sizes");
  command->add_option("--window", options->window, "samples in the window, 900 unless given")
      ->check(CLI::Range(10, 20'000));
  cli::add_out(command, options->out, "folder for bench.json");
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
}

}  // namespace kelpie::lab
