// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

#include <string>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/run_program.hpp"
#include "kelpie/core/error.hpp"
#ifdef KELPIE_WITH_LIVE
#include "console/commands.hpp"
#endif

namespace kelpie::cli {
namespace {

// A command that this program is without says where the command is.
void add_absent(CLI::App& app, const std::string& name, const std::string& where) {
  app.add_subcommand(name)->group("")->allow_extras()->callback(
      [=] { throw InputError({.file = "kelpie " + name, .line = 0, .field = {}}, where); });
}

// For a version or two.
void add_moved(CLI::App& app, const std::string& name) {
  add_absent(
      app, name,
      "has moved to `kelpie-lab " + name + "`, which a build with -DKELPIE_BUILD_LAB=ON makes");
}

}  // namespace

int program(const std::vector<std::string>& words, const Streams& streams) {
  CLI::App app{"kelpie learns the dynamics of an underwater vehicle while it drives.", "kelpie"};
  app.set_version_flag("--version", "kelpie " KELPIE_VERSION);
  app.require_subcommand(1);
  add_learn(app);
#ifdef KELPIE_WITH_LIVE
  add_live(app);
  add_play(app);
#else
  for (const char* const command : {"live", "play"}) {
    add_absent(app, command,
               "is not in this build: `scripts/build.sh user` makes build/user/kelpie with it");
  }
#endif
  add_predict(app);
  add_export(app);
  add_memory(app);
  add_compare(app);
  add_tune(app);
  add_study(app);
  add_config(app);
  add_simulate(app);
  add_vehicle(app);
  add_health(app);
  add_identify(app);
  add_plan(app);
  add_inspect(app);
  add_convert(app);
  add_rollout(app);
  add_completion(app);
  add_examples(&app, "learn dive.csv --rate 4", "learn --help");
  add_help(app);
  add_moved(app, "bench");
  add_moved(app, "reproduce");
  return run_program(app, words, streams);
}

}  // namespace kelpie::cli
