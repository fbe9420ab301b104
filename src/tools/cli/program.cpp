// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

#include <string>

#include "cli/commands.hpp"
#include "cli/run_program.hpp"
#ifdef KELPIE_WITH_LIVE
#include "console/commands.hpp"
#endif

namespace kelpie::cli {
namespace {

#ifndef KELPIE_WITH_LIVE
void add_elsewhere(CLI::App& app) {
  for (const char* const command : {"live", "play"}) {
    add_absent(app, command,
               "is not in this build: `scripts/build.sh user` makes build/user/kelpie with it");
  }
}
#endif

// For a version or two.
void add_moved(CLI::App& app) {
  for (const std::string name : {"bench", "reproduce"}) {
    add_absent(
        app, name,
        "has moved to `kelpie-lab " + name + "`, which a build with -DKELPIE_BUILD_LAB=ON makes");
  }
}

void add_first_steps(CLI::App& app) {
  add_examples(&app, "learn dive.csv --rate 4", "help learn");
}

}  // namespace

int program(const std::vector<std::string>& words, const Streams& streams) {
  return run_program(
      "kelpie", "kelpie learns the dynamics of an underwater vehicle while it drives.",
      {add_inspect, add_learn,      add_predict,     add_rollout,
#ifdef KELPIE_WITH_LIVE
       add_live,
#else
       add_elsewhere,
#endif
       add_export,  add_simulate,   add_vehicle,     add_identify, add_plan,   add_health,
       add_compare, add_tune,       add_study,       add_convert,  add_memory,
#ifdef KELPIE_WITH_LIVE
       add_play,
#endif
       add_config,  add_completion, add_first_steps, add_help,     add_moved,  group_commands},
      words, streams);
}

}  // namespace kelpie::cli
