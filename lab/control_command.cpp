// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>
#include <string>

#include "cli/interrupt.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "file/atomic_file.hpp"
#include "kelpie/core/error.hpp"
#include "lab/commands.hpp"
#include "lab/control_report.hpp"
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
  const std::string file = options.scenario.empty() ? (scenario_folder() / "small.toml").string()
                                                    : options.scenario;
  plan.vehicle = vehicle::read_scenario(file).vehicle;
  if (options.quick) {
    plan.commissioning_s = 120.0;
    plan.times = {.settle_s = 10.0, .before_s = 20.0, .during_s = 20.0, .after_s = 20.0};
  }
  const file::OutFolder folder =
      cli::take_out_folder(options.out, {"control.json", "control.html"}, {options.scenario});
  const cli::InterruptGuard guard;
  ControlResult result;
  {
    cli::ProgressBar progress("driving");
    plan.keep_going = [&](double share) {
      progress.at(share);
      return !cli::InterruptGuard::asked();
    };
    result = run_control(plan);
  }
  if (result.interrupted) {
    throw Failure("interrupted; nothing was written");
  }
  file::write_files_whole(folder.path(), {{"control.json", control_json(result)},
                                          {"control.html", control_html(result)}});
  fmt::print("{}page:    {}\nnumbers: {}\n", control_table(result),
             (folder.path() / "control.html").string(), (folder.path() / "control.json").string());
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
  command->add_option("--out", options->out, "folder for control.html and control.json")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->callback([options] { control(*options); });
}

}  // namespace kelpie::lab
