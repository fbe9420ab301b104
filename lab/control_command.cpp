// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "kelpie/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/control_report.hpp"
#include "lab/report_run.hpp"
#include "lab/scenario_folder.hpp"
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
  const std::string file =
      options.scenario.empty() ? (scenario_folder() / "small.toml").string() : options.scenario;
  plan.vehicle = vehicle::read_scenario(file).vehicle;
  if (options.quick) {
    plan.commissioning_s = 120.0;
    plan.times = {.settle_s = 10.0, .before_s = 20.0, .during_s = 20.0, .after_s = 20.0};
  }
  const file::OutFolder folder = take_report_folder(options.out, "control", {options.scenario});
  const ControlResult result = run_watched("driving", [&](const auto& keep_going) {
    plan.keep_going = keep_going;
    return run_control(plan);
  });
  write_report(folder, "control", {control_table(result), control_json(result)});
}

}  // namespace

void add_control(CLI::App& app) {
  auto options = std::make_shared<ControlArguments>();
  CLI::App* const command = app.add_subcommand(
      "control", "Measure how well the simulated vehicle follows paths, under four controllers");
  command
      ->add_option("--scenario", options->scenario,
                   "file whose vehicle drives; else scenarios/small.toml here, or with the program")
      ->type_name("FILE");
  command->add_option("--seeds", options->plan.seeds, "of noise and current")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", options->plan.first_seed, "the first of them")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--threads", options->plan.threads, "0: one per core")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--quick", options->quick, "missions of a minute: to see that it works");
  command->add_option("--out", options->out, "folder for control.json")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options] { control(*options); });
}

}  // namespace kelpie::lab
