// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

#include "cli/run_program.hpp"
#include "lab/commands.hpp"

namespace kelpie::cli {
#ifndef KELPIE_WITH_STUDIES
namespace {

void add_studies_elsewhere(CLI::App& app) {
  for (const char* const study : {"bench", "benchmark", "control", "dead-reckoning", "diagnose",
                                  "health", "hostile", "identify", "plan"}) {
    add_absent(app, study,
               "is not in this build: `scripts/build.sh release kelpie_lab` makes "
               "build/release/kelpie-lab with all studies");
  }
}

}  // namespace
#endif

int program(const std::vector<std::string>& words, const Streams& streams) {
  return run_program(
      "kelpie-lab", "kelpie-lab measures the paper's claims, the opponents and all times again.",
      {lab::add_reproduce,
#ifdef KELPIE_WITH_STUDIES
       lab::add_bench, lab::add_benchmark, lab::add_control, lab::add_reckoning, lab::add_diagnose,
       lab::add_health, lab::add_hostile, lab::add_identify, lab::add_opponents, lab::add_plan
#else
       add_studies_elsewhere
#endif
      },
      words, streams);
}

}  // namespace kelpie::cli
