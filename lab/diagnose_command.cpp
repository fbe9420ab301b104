// SPDX-License-Identifier: Apache-2.0
#include "lab/commands.hpp"
#include "lab/diagnosis_study.hpp"
#include "simulator/scenario_file.hpp"

namespace kelpie::lab {
namespace {

struct DiagnoseArguments {
  bool quick = false;
  std::string scenarios;
  std::size_t seeds = 20;
  std::uint64_t seed = 1;
  double hours = 24.0;
  std::size_t threads = 0;
  std::string out = "out/diagnose";
};

void diagnose(const DiagnoseArguments& options) {
  const std::filesystem::path folder =
      options.scenarios.empty() ? scenario_folder() : std::filesystem::path(options.scenarios);
  const DiagnosisPlan plan{.scenario = simulator::read_scenario(folder / "diagnosis.toml"),
                           .seeds = options.quick ? 1 : options.seeds,
                           .first_seed = options.seed,
                           .nominal_hours = options.quick ? 1.0 : options.hours,
                           .threads = options.threads};
  run_study({options.out, "diagnosis", "diagnosing"}, plan, study_diagnosis,
            [](const DiagnosisStudy& study) {
              return StudyReport{diagnosis_table(study), diagnosis_json(study)};
            });
}

}  // namespace

void add_diagnose(CLI::App& app) {
  const auto [command, options] = cli::add_command<DiagnoseArguments>(
      app, "diagnose", "Change a simulated vehicle in every way, and see what is said of it",
      diagnose);
  command->add_flag("--quick", options->quick, "one seed and one hour, in a minute");
  cli::add_folder(command, "--scenarios", options->scenarios,
                  "folder of diagnosis.toml; else `scenarios` here, or with the program");
  add_seeds(command, options->seeds, "how many");
  command
      ->add_option("--hours", options->hours,
                   "of driving without a change, for every fifth seed; 0: none")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  add_run_options(command, options->seed, options->threads, options->out, "diagnosis.json");
}

}  // namespace kelpie::lab
