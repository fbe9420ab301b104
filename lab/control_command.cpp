// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "core/text.hpp"
#include "jobs/run_all.hpp"
#include "lab/closed_loop.hpp"
#include "lab/commands.hpp"
#include "lab/controllers.hpp"
#include "lab/json_table.hpp"
#include "simulator/scenario_file.hpp"

namespace kelpie::lab {
namespace {

// The controllers.
enum class ControllerKind {
  pid,                  // (a)
  feed_forward,         // (b)
  learned,              // (c)
  adaptive,             // (d)
  reallocated,          // (e)
  learned_reallocated,  // (f)
  predictive,           // (g)
};
inline constexpr std::array kControllers{
    ControllerKind::pid,       ControllerKind::feed_forward, ControllerKind::learned,
    ControllerKind::adaptive,  ControllerKind::reallocated,  ControllerKind::learned_reallocated,
    ControllerKind::predictive};

// The plan of a study: vehicle, seeds and lengths of the missions.
struct ControlPlan {
  simulator::VehicleParameters vehicle;
  std::size_t seeds = 5;
  std::vector<Mishap> mishaps{kMishaps.begin(), kMishaps.end()};
  std::uint64_t first_seed = 1;
  MissionTimes times{};
  double commissioning_s = 600.0;  // learning time of (c) before its missions
  std::size_t threads = 0;         // 0: one per core
  // Called now and then with the finished share; false stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

// The missions of one path and one mishap: [controller][seed].
struct ControlCase {
  PathKind path = PathKind::lawn_mower;
  Mishap mishap = Mishap::none;
  std::array<std::vector<MissionErrors>, kControllers.size()> flown{};
};

// The results of a study.
struct ControlResult {
  std::size_t seeds = 0;
  std::uint64_t first_seed = 1;
  MissionTimes times{};
  std::vector<ControlCase> cases;
  bool interrupted = false;
};

std::unique_ptr<Controller> make_controller(ControllerKind kind, const NominalModel& nominal,
                                            const DynamicsModel& learned) {
  switch (kind) {
    case ControllerKind::pid:
      return make_pid(nominal, false);
    case ControllerKind::feed_forward:
      return make_pid(nominal, true);
    case ControllerKind::learned:
      return make_learned(nominal, learned);
    case ControllerKind::adaptive:
      return make_adaptive(nominal);
    case ControllerKind::reallocated:
      return make_pid(nominal, true, learned.diagnosis());
    case ControllerKind::learned_reallocated:
      return make_learned(nominal, learned, true);
    case ControllerKind::predictive:
      return make_predictive(nominal);
  }
  return nullptr;
}

constexpr std::size_t index_of(ControllerKind kind) {
  return static_cast<std::size_t>(kind);
}

std::string controller_name(ControllerKind kind) {
  switch (kind) {
    case ControllerKind::pid:
      return "(a) PID";
    case ControllerKind::feed_forward:
      return "(b) PID, nominal model";
    case ControllerKind::learned:
      return "(c) PID, learned model";
    case ControllerKind::adaptive:
      return "(d) adaptive";
    case ControllerKind::reallocated:
      return "(e) nominal, re-allocated";
    case ControllerKind::learned_reallocated:
      return "(f) learned, re-allocated";
    case ControllerKind::predictive:
      return "(g) predictive";
  }
  return {};
}

// The largest ratio of the errors of (c) and (a), over seeds and phases.
double worst_against_pid(const ControlCase& one) {
  const std::vector<MissionErrors>& pid = one.flown[index_of(ControllerKind::pid)];
  const std::vector<MissionErrors>& learned = one.flown[index_of(ControllerKind::learned)];
  double worst = 0.0;
  for (std::size_t seed = 0; seed < pid.size(); ++seed) {
    for (const auto phase :
         {&MissionErrors::before, &MissionErrors::during, &MissionErrors::after}) {
      worst = std::max(worst, learned[seed].*phase / (pid[seed].*phase));
    }
  }
  return worst;
}

double mean_of(const file::Json& values) {
  double sum = 0.0;
  for (const file::Json& value : values) {
    sum += value.get<double>();
  }
  return sum / static_cast<double>(values.size());
}

file::Json case_json(const ControlCase& one) {
  file::Json controllers = file::Json::array();
  for (std::size_t i = 0; i < kControllers.size(); ++i) {
    const auto every = [&](double MissionErrors::*value) {
      return file::list(one.flown[i],
                        [&](const auto& errors) { return file::number(errors.*value); });
    };
    controllers.push_back({{"name", controller_name(kControllers[i])},
                           {"before_m", every(&MissionErrors::before)},
                           {"during_m", every(&MissionErrors::during)},
                           {"after_m", every(&MissionErrors::after)},
                           {"fallback_share", every(&MissionErrors::fallback_share)},
                           {"time_s", file::numbers(one.flown[i].front().time_s)},
                           {"error_m", file::numbers(one.flown[i].front().error_m)}});
  }
  return {{"path", path_name(one.path)},
          {"mishap", mishap_name(one.mishap)},
          {"worst_c_over_a", file::number(worst_against_pid(one))},
          {"controllers", std::move(controllers)}};
}

ControlResult run_control(const ControlPlan& plan) {
  ControlResult result{
      .seeds = plan.seeds, .first_seed = plan.first_seed, .times = plan.times, .cases = {}};
  for (const PathKind path : kPaths) {
    for (const Mishap mishap : plan.mishaps) {
      ControlCase& one = result.cases.emplace_back(ControlCase{path, mishap, {}});
      for (std::vector<MissionErrors>& flown : one.flown) {
        flown.resize(plan.seeds);
      }
    }
  }
  const NominalModel nominal(plan.vehicle);
  std::vector<DynamicsModel> learned;
  for (std::size_t seed = 0; seed < plan.seeds; ++seed) {
    learned.push_back(commissioned(plan.vehicle, plan.commissioning_s, plan.first_seed + seed));
  }
  const auto missions = [&](std::size_t job) {
    const std::size_t seed = job / result.cases.size();
    ControlCase& one = result.cases[job % result.cases.size()];
    for (const ControllerKind kind : kControllers) {
      const auto controller = make_controller(kind, nominal, learned[seed]);
      const Mission mission{one.path, one.mishap, plan.times, plan.first_seed + seed};
      one.flown[index_of(kind)][seed] = fly(plan.vehicle, mission, *controller);
    }
  };
  result.interrupted =
      !jobs::run_while(plan.keep_going, result.cases.size() * plan.seeds, plan.threads, missions);
  return result;
}

std::string control_table(const ControlResult& result) {
  std::vector<JsonColumn> columns{{"mission", [](const file::Json& one) {
                                     return one["path"].get<std::string>() + ", " +
                                            one["mishap"].get<std::string>();
                                   }}};
  for (const ControllerKind kind : kControllers) {
    columns.push_back({controller_name(kind), [kind](const file::Json& one) {
                         const file::Json& flown = one["controllers"][index_of(kind)];
                         return fmt::format(
                             "{:.1f} / {:.1f} / {:.1f}", 1e3 * mean_of(flown["before_m"]),
                             1e3 * mean_of(flown["during_m"]), 1e3 * mean_of(flown["after_m"]));
                       }});
  }
  columns.push_back(column("worst (c)/(a)", "/worst_c_over_a", fixed("{:.2f}")));
  chart::TextTable table = json_table(
      fmt::format("Distance to where the vehicle should be, root mean square in mm, mean of {} "
                  "seeds (simulation): before / during / after",
                  result.seeds),
      columns, file::list(result.cases, case_json));
  table.whole = true;
  return chart::table_text(table);
}

std::string control_json(const ControlResult& result) {
  const MissionTimes& times = result.times;
  const file::Json document = {{"format", "kelpie-control"},
                               {"version", 1},
                               {"simulated", true},
                               {"seeds", result.seeds},
                               {"first_seed", result.first_seed},
                               {"settle_s", times.settle_s},
                               {"before_s", times.before_s},
                               {"during_s", times.during_s},
                               {"after_s", times.after_s},
                               {"cases", file::list(result.cases, case_json)}};
  return file::json_text(document, 1);
}

// The mishaps of these names, all without any.
std::vector<Mishap> wanted_mishaps(const std::vector<std::string>& names) {
  std::vector<Mishap> wanted;
  std::vector<std::string> known;
  for (const Mishap mishap : kMishaps) {
    known.push_back(mishap_name(mishap));
    if (names.empty() || std::ranges::find(names, known.back()) != names.end()) {
      wanted.push_back(mishap);
    }
  }
  for (const std::string& name : names) {
    require_name("--mishap", name, "mishap", known);
  }
  return wanted;
}

struct ControlArguments {
  std::string scenario;
  std::vector<std::string> mishaps;
  bool quick = false;
  ControlPlan plan;
  std::string out = "out/control";
};

void control(const ControlArguments& options) {
  ControlPlan plan = options.plan;
  plan.mishaps = wanted_mishaps(options.mishaps);
  plan.vehicle = simulator::read_scenario(scenario_file(options.scenario, "small.toml")).vehicle;
  simulator::require_plane(plan.vehicle);
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
      "Measure how well the simulated vehicle follows paths, through damage, currents and outages",
      control);
  cli::add_file(command, "--scenario", options->scenario,
                "file whose vehicle drives; else scenarios/small.toml here, or with the program");
  command->add_option("--mishap", options->mishaps, "of these names alone (repeatable); else all");
  add_seeds(command, options->plan.seeds, "of noise and current");
  add_run_options(command, options->plan.first_seed, options->plan.threads, options->out,
                  "control.json");
  command->add_flag("--quick", options->quick, "missions of a minute: to see that it works");
}

}  // namespace kelpie::lab
