// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "kelpie/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/diagnosis_report.hpp"
#include "lab/report_run.hpp"
#include "lab/scenario_folder.hpp"
#include "vehicle/scenario_file.hpp"

namespace kelpie::lab {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScenario = "diagnosis.toml";

struct DiagnoseArguments {
  bool quick = false;
  std::string scenarios;
  std::size_t seeds = 20;
  std::uint64_t seed = 1;
  double hours = 24.0;
  std::size_t threads = 0;
  std::string out = "out/diagnose";
};

DiagnosisPlan plan_of(const DiagnoseArguments& options) {
  const fs::path folder =
      options.scenarios.empty() ? scenario_folder() : fs::path(options.scenarios);
  DiagnosisPlan plan;
  plan.scenario = vehicle::read_scenario(folder / kScenario);
  plan.seeds = options.quick ? 1 : options.seeds;
  plan.first_seed = options.seed;
  plan.nominal_hours = options.quick ? 1.0 : options.hours;
  plan.threads = options.threads;
  return plan;
}

void run_diagnose(const DiagnoseArguments& options) {
  DiagnosisPlan plan = plan_of(options);
  const file::OutFolder folder = take_report_folder(options.out, "diagnosis", {});
  const DiagnosisStudy study = run_watched("diagnosing", [&](const auto& keep_going) {
    plan.keep_going = keep_going;
    return study_diagnosis(plan);
  });
  write_report(folder, "diagnosis", {diagnosis_table(study), diagnosis_json(study)});
}

}  // namespace

void add_diagnose(CLI::App& app) {
  auto options = std::make_shared<DiagnoseArguments>();
  CLI::App* const command = app.add_subcommand(
      "diagnose", "Change a simulated vehicle in every way, and see what is said of it");
  command->add_flag("--quick", options->quick, "one seed and one hour, in a minute");
  command
      ->add_option("--scenarios", options->scenarios,
                   "folder of diagnosis.toml; else `scenarios` here, or with the program")
      ->type_name("FOLDER");
  command->add_option("--seeds", options->seeds, "how many")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", options->seed, "the first of them")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--hours", options->hours,
                   "of driving without a change, for every fifth seed; 0: none")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--threads", options->threads, "0: one per core")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--out", options->out, "folder for diagnosis.json")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options] { run_diagnose(*options); });
}

}  // namespace kelpie::lab
