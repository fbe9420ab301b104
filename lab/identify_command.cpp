// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "cli/output.hpp"
#include "kelpie/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/identify_study.hpp"
#include "lab/report_run.hpp"
#include "vehicle/scenario_file.hpp"

namespace kelpie::lab {
namespace {

struct IdentifyStudyArguments {
  std::string scenario;
  std::size_t seeds = 20;
};

std::string share_of(double part, double whole) {
  return std::abs(whole) > 1e-9 ? fmt::format("{:.2f}", 100.0 * part / std::abs(whole)) : "–";
}

std::string study_text(const IdentifyStudy& study) {
  chart::TextTable table{"Parameters over all seeds",
                         {"parameter", "truth", "mean", "rms error\n%", "worst\n%",
                          "mean standard\nerror %", "in the 90 %\ninterval"},
                         {}};
  for (const IdentifiedParameter& row : study.parameters) {
    table.rows.push_back(
        {row.name, chart::significant(row.truth), chart::significant(row.mean),
         share_of(row.root_mean_square_error, row.truth), share_of(row.worst_error, row.truth),
         share_of(row.mean_standard_error, row.truth), fmt::format("{:.2f}", row.coverage)});
  }
  return chart::table_text(table) +
         fmt::format(
             "{} seeds; {:.3f} of all parameters in their 90 % intervals, {:.2f} in the "
             "worst seed; mean misfit {:.2f}\n",
             study.seeds, study.coverage, std::ranges::min(study.per_seed), study.mean_misfit);
}

void run_identify_study(const IdentifyStudyArguments& options) {
  require(options.seeds > 0, "--seeds", "has to be > 0");
  const vehicle::Scenario scenario = vehicle::read_scenario(options.scenario);
  require(scenario.configurations.size() == 1, "scenario", "has to have one configuration");
  const IdentifyStudy study = run_watched("identifying", [&](const auto& keep_going) {
    return study_identification(
        {.scenario = scenario, .seeds = options.seeds, .keep_going = keep_going});
  });
  cli::say("{}", study_text(study));
}

}  // namespace

void add_identify(CLI::App& app) {
  auto options = std::make_shared<IdentifyStudyArguments>();
  CLI::App* const command = app.add_subcommand(
      "identify", "Simulate and identify from many seeds: errors and coverage of intervals");
  command->add_option("scenario", options->scenario, "scenario of one configuration")
      ->required()
      ->type_name("FILE");
  command->add_option("--seeds", options->seeds, "from the scenario's own on")
      ->capture_default_str();
  command->callback([options] { run_identify_study(*options); });
}

}  // namespace kelpie::lab
