// SPDX-License-Identifier: Apache-2.0
#include "cli/run_program.hpp"
#include "lab/commands.hpp"

// NOLINTNEXTLINE(bugprone-exception-escape): options throw only where two have one name
int main(int argc, char** argv) {
  CLI::App app{"kelpie-lab measures the paper's claims, the opponents and all times again.",
               "kelpie-lab"};
  app.set_version_flag("--version", "kelpie-lab " KELPIE_VERSION);
  app.require_subcommand(1);
  kelpie::lab::add_reproduce(app);
  kelpie::lab::add_bench(app);
  kelpie::lab::add_benchmark(app);
  kelpie::lab::add_control(app);
  kelpie::lab::add_reckoning(app);
  kelpie::lab::add_diagnose(app);
  kelpie::lab::add_health(app);
  kelpie::lab::add_hostile(app);
  kelpie::lab::add_identify(app);
  kelpie::lab::add_plan(app);
  return kelpie::cli::run_program(app, argc, argv);
}
