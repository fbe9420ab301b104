// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

#include "cli/run_program.hpp"
#include "lab/commands.hpp"

namespace kelpie::cli {

int program(const std::vector<std::string>& words, const Streams& streams) {
  CLI::App app{"kelpie-lab measures the paper's claims, the opponents and all times again.",
               "kelpie-lab"};
  app.set_version_flag("--version", "kelpie-lab " KELPIE_VERSION);
  app.require_subcommand(1);
  lab::add_reproduce(app);
  lab::add_bench(app);
  lab::add_benchmark(app);
  lab::add_control(app);
  lab::add_reckoning(app);
  lab::add_diagnose(app);
  lab::add_health(app);
  lab::add_hostile(app);
  lab::add_identify(app);
  lab::add_plan(app);
  return run_program(app, words, streams);
}

}  // namespace kelpie::cli
