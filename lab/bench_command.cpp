// SPDX-License-Identifier: Apache-2.0
#include "cli/output.hpp"

#include "lab/commands.hpp"
#include "lab/soak.hpp"
#include "lab/update_times.hpp"

namespace kelpie::lab {
namespace {

struct BenchArguments {
  std::size_t soak = 0;
  std::size_t updates = 0;
  double budget_ms = 0.0;
};

// Runs `measure`, which takes a function to call with the number of finished updates.
template <typename Measure>
auto run_counted(const char* name, std::size_t updates, Measure measure) {
  return run_watched(
      name,
      [&](const auto& keep_going) {
        return measure([&](std::size_t done) {
          return keep_going(static_cast<double>(done) / static_cast<double>(updates));
        });
      },
      true);
}

void bench(const BenchArguments& options) {
  if (options.soak > 0) {
    const SoakRun run = run_counted("soaking", options.soak, [&](const auto& keep_going) {
      return run_soak({.updates = options.soak, .keep_going = keep_going});
    });
    cli::say("{}\n", soak_text(run));
    if (!run.good()) {
      throw Failure("the solver did not keep to what it promises");
    }
  } else if (options.updates > 0) {
    const UpdateTimes times = run_counted("driving", options.updates, [&](const auto& keep_going) {
      return measure_update_times({.updates = options.updates,
                                   .budget_us = 1e3 * options.budget_ms,
                                   .keep_going = keep_going});
    });
    cli::say("{}", times_table(times));
  } else {
    throw InputError("bench", "give --updates or --soak");
  }
}

}  // namespace

void add_bench(CLI::App& app) {
  const auto [command, options] = cli::add_command<BenchArguments>(
      app, "bench", "Measure how long updates take, and soak the path solver", bench);
  command
      ->add_option("--soak", options->soak,
                   "keep the path solver at it for so many updates and check it")
      ->check(CLI::PositiveNumber);
  CLI::Option* const updates =
      command
          ->add_option("--updates", options->updates,
                       "time so many single updates of a model with three axes, to which twenty "
                       "changes and as many new scales happen")
          ->check(CLI::PositiveNumber);
  command
      ->add_option("--budget", options->budget_ms, "of each of these updates, in ms of its thread")
      ->check(CLI::PositiveNumber)
      ->needs(updates);
}

}  // namespace kelpie::lab
