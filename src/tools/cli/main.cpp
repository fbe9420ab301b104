// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/run_program.hpp"
#include "kelpie/core/error.hpp"
#ifdef KELPIE_WITH_LIVE
#include "console/commands.hpp"
#endif

namespace {

// Commands that went to the laboratory say so for a version or two.
void add_moved(CLI::App& app, const std::string& name) {
  CLI::App* const command = app.add_subcommand(name)->group("")->allow_extras();
  command->callback([name] {
    throw kelpie::InputError(
        {.file = "kelpie " + name, .line = 0, .field = {}},
        "has moved to `kelpie-lab " + name + "`, which a build with -DKELPIE_BUILD_LAB=ON makes");
  });
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): options throw only where two have one name
int main(int argc, char** argv) {
  CLI::App app{"kelpie learns the dynamics of an underwater vehicle while it drives.", "kelpie"};
  app.set_version_flag("--version", "kelpie " KELPIE_VERSION);
  app.require_subcommand(1);
  kelpie::cli::add_learn(app);
#ifdef KELPIE_WITH_LIVE
  kelpie::cli::add_live(app);
  kelpie::cli::add_play(app);
#endif
  kelpie::cli::add_predict(app);
  kelpie::cli::add_export(app);
  kelpie::cli::add_memory(app);
  kelpie::cli::add_compare(app);
  kelpie::cli::add_tune(app);
  kelpie::cli::add_study(app);
  kelpie::cli::add_config(app);
  kelpie::cli::add_simulate(app);
  kelpie::cli::add_vehicle(app);
  kelpie::cli::add_health(app);
  kelpie::cli::add_identify(app);
  kelpie::cli::add_plan(app);
  kelpie::cli::add_inspect(app);
  kelpie::cli::add_convert(app);
  kelpie::cli::add_rollout(app);
  kelpie::cli::add_completion(app);
  kelpie::cli::add_examples(&app, "learn dive.csv --rate 4", "learn --help");
  kelpie::cli::add_help(app);
  add_moved(app, "bench");
  add_moved(app, "reproduce");
  return kelpie::cli::run_program(app, argc, argv);
}
