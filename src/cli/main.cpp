// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <exception>

#include "cli/commands.hpp"
#include "kelpie/core/error.hpp"

namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

int run(int argc, char** argv) {
  CLI::App app{"kelpie learns the dynamics of an underwater vehicle while it drives."};
  app.set_version_flag("--version", "kelpie " KELPIE_VERSION);
  app.require_subcommand(1);
  kelpie::cli::add_learn(app);
  kelpie::cli::add_predict(app);
  kelpie::cli::add_export(app);
  kelpie::cli::add_memory(app);
  kelpie::cli::add_tune(app);
  kelpie::cli::add_config(app);
  kelpie::cli::add_simulate(app);
  kelpie::cli::add_inspect(app);
  kelpie::cli::add_convert(app);
  kelpie::cli::add_bench(app);
  kelpie::cli::add_reproduce(app);
  kelpie::cli::add_rollout(app);
  kelpie::cli::add_completion(app);
  kelpie::cli::add_manual(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const kelpie::InputError& error) {
    fmt::print(stderr, "kelpie: {}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "kelpie: {}\n", error.what());
    return kFailed;
  }
}
