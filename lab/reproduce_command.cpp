// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cstdlib>
#include <optional>

#include "cli/output.hpp"
#include "file/content.hpp"
#include "file/json.hpp"
#include "lab/commands.hpp"
#include "lab/reproduction_report.hpp"

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
  std::vector<std::string> entries;
  std::string drawn;
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
  plan.entries = options.entries;
  plan.threads = options.threads;
  plan.version = KELPIE_VERSION;
  plan.command += options.quick ? " --quick" : "";
  plan.command += options.scenario == "paper" ? "" : " --scenario " + options.scenario;
  plan.command += options.seeds ? fmt::format(" --seeds {}", *options.seeds) : "";
  plan.command += options.seed == 1 ? "" : fmt::format(" --seed {}", options.seed);
  for (const std::string& entry : plan.entries) {
    plan.command += " --entry " + entry;
  }
  plan.validate();
  return plan;
}

StudyReport report_of(const file::Json& document) {
  return {reproduction_table(document), file::one_line(document) + "\n",
          reproduction_html(document), reproduction_markdown(document)};
}

// The pages of an earlier run, by today's rules.
void draw_again(const ReproduceArguments& options) {
  constexpr std::size_t kMostBytes = 1U << 28U;
  const StudyOutput output{options.out, "reproduction", "drawing"};
  file::Json document = file::parse_json(
      file::read_content(options.drawn, "reproduction.json", kMostBytes), options.drawn);
  in_file(options.drawn, [&] { judge_claims(document); });
  output.write(output.take(), report_of(document));
}

void run_reproduce(const ReproduceArguments& options) {
  if (!options.drawn.empty()) {
    return draw_again(options);
  }
  const ReproductionPlan plan = make_plan(options);
  if (plan.data.empty()) {
    cli::say("The real log is not here: simulation only.\n\n");
  }
  run_study({options.out, "reproduction", "reproducing"}, plan, reproduce,
            [](const Reproduction& result) { return report_of(reproduction_document(result)); });
}

}  // namespace

void add_reproduce(CLI::App& app) {
  const auto [command, options] = cli::add_command<ReproduceArguments>(
      app, "reproduce", "Measure the paper's claims again and write one page about it",
      run_reproduce);
  command->add_flag("--quick", options->quick, "shorter streams and fewer seeds, in a minute");
  cli::add_folder(command, "--scenarios", options->scenarios,
                  "folder of the scenario files; else `scenarios` here, or with the program");
  command->add_option("--scenario", options->scenario, "of the main simulated stream")
      ->capture_default_str();
  cli::add_folder(command, "--data", options->data,
                  "folder of the real log; else $KELPIE_DATA_DIR or ../shared/data");
  command->add_option("--seeds", options->seeds, "how many: 5, or 1 with --quick")
      ->check(CLI::PositiveNumber);
  command->add_option("--entry", options->entries,
                      "a learner of yours beside the rows: FILE.py:CLASS or MODULE:CLASS with "
                      "partial_fit and predict, as in the open benchmark; repeatable");
  cli::add_file(command, "--draw", options->drawn,
                "draws the pages of an earlier reproduction.json again; nothing is measured");
  add_run_options(command, options->seed, options->threads, options->out,
                  "reproduction.html, reproduction.md and reproduction.json");
}

}  // namespace kelpie::lab
