// SPDX-License-Identifier: Apache-2.0
#include "lab/commands.hpp"
#include "lab/control_study.hpp"
#include "vehicle/scenario_file.hpp"

namespace kelpie::lab {
namespace {

struct ControlArguments {
  std::string scenario;
  bool quick = false;
  ControlPlan plan;
  std::string out = "out/control";
};

void control(const ControlArguments& options) {
  ControlPlan plan = options.plan;
  plan.vehicle = vehicle::read_scenario(scenario_file(options.scenario, "small.toml")).vehicle;
  if (options.quick) {
    plan.commissioning_s = 120.0;
    plan.times = {.settle_s = 10.0, .before_s = 20.0, .during_s = 20.0, .after_s = 20.0};
  }
  run_study({options.out, "control", "driving", {options.scenario}}, plan, run_control,
            [](const ControlResult& result) {
              return StudyReport{control_table(result), control_json(result)};
            });
}

}  // namespace

void add_control(CLI::App& app) {
  const auto [command, options] = cli::add_command<ControlArguments>(
      app, "control",
      "Measure how well the simulated vehicle follows paths, under four controllers", control);
  cli::add_file(command, "--scenario", options->scenario,
                "file whose vehicle drives; else scenarios/small.toml here, or with the program");
  add_seeds(command, options->plan.seeds, "of noise and current");
  add_run_options(command, options->plan.first_seed, options->plan.threads, options->out,
                  "control.json");
  command->add_flag("--quick", options->quick, "missions of a minute: to see that it works");
}

}  // namespace kelpie::lab
