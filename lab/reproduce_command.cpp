// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "kelpie/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/report_run.hpp"
#include "lab/reproduction.hpp"
#include "lab/reproduction_report.hpp"
#include "lab/scenario_folder.hpp"

namespace kelpie::lab {
namespace {

namespace fs = std::filesystem;

struct ReproduceArguments {
  bool quick = false;
  std::string scenarios;
  std::string scenario = "paper";
  std::string data;
  std::optional<std::size_t> seeds;
  std::uint64_t seed = 1;
  std::size_t threads = 0;
  std::string out = "out/reproduce";
};

// The folder asked for has to hold the log; the usual ones may.
fs::path data_folder(const ReproduceArguments& options) {
  if (!options.data.empty()) {
    fs::path folder = options.data;
    if (!fs::exists(folder / kRealLogName)) {
      throw InputError({.file = options.data, .line = 0, .field = "--data"},
                       fmt::format("there is no {} in it; without --data only what is found in "
                                   "$KELPIE_DATA_DIR or ../shared/data is used",
                                   kRealLogName));
    }
    return folder;
  }
  const char* const named = std::getenv("KELPIE_DATA_DIR");  // NOLINT: no thread writes it
  for (const fs::path& folder :
       {fs::path(named == nullptr ? "" : named), fs::path("../shared/data")}) {
    if (!folder.empty() && fs::exists(folder / kRealLogName)) {
      return fs::path{folder};
    }
  }
  return {};
}

ReproductionPlan make_plan(const ReproduceArguments& options) {
  ReproductionPlan plan = options.quick ? quick_plan() : full_plan();
  plan.scenarios = options.scenarios.empty() ? scenario_folder() : fs::path(options.scenarios);
  plan.scenario = options.scenario;
  plan.data = data_folder(options);
  plan.seeds = options.seeds.value_or(plan.seeds);
  plan.first_seed = options.seed;
  plan.threads = options.threads;
  plan.validate();
  return plan;
}

void run_reproduce(const ReproduceArguments& options) {
  ReproductionPlan plan = make_plan(options);
  if (plan.data.empty()) {
    fmt::print("The real log is not here: simulation only.\n\n");
  }
  const file::OutFolder folder = take_report_folder(options.out, "reproduction", {});
  const Reproduction result = run_watched("reproducing", [&](const auto& keep_going) {
    plan.keep_going = keep_going;
    return reproduce(plan);
  });
  write_report(folder, "reproduction",
               {reproduction_table(result), reproduction_json(result), reproduction_html(result)});
}

}  // namespace

void add_reproduce(CLI::App& app) {
  auto options = std::make_shared<ReproduceArguments>();
  CLI::App* const command = app.add_subcommand(
      "reproduce", "Measure the paper's claims again and write one page about it");
  command->add_flag("--quick", options->quick, "shorter streams and fewer seeds, in a minute");
  command
      ->add_option("--scenarios", options->scenarios,
                   "folder of the scenario files; else `scenarios` here, or with the program")
      ->type_name("FOLDER");
  command->add_option("--scenario", options->scenario, "of the main simulated stream")
      ->capture_default_str();
  command
      ->add_option("--data", options->data,
                   "folder of the real log; else $KELPIE_DATA_DIR or ../shared/data")
      ->type_name("FOLDER");
  command->add_option("--seeds", options->seeds, "how many: 5, or 1 with --quick")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed, "the first of them")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--threads", options->threads, "0: one per core")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--out", options->out, "folder for reproduction.html and reproduction.json")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options] { run_reproduce(*options); });
}

}  // namespace kelpie::lab
