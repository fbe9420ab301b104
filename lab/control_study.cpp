// SPDX-License-Identifier: Apache-2.0
#include "lab/control_study.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "chart/text_table.hpp"
#include "jobs/run_all.hpp"
#include "lab/json_table.hpp"
#include "lab/learned_controller.hpp"

namespace kelpie::lab {
namespace {

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
  }
  return nullptr;
}

constexpr std::size_t index_of(ControllerKind kind) {
  return static_cast<std::size_t>(kind);
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

}  // namespace

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
  }
  return {};
}

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

ControlResult run_control(const ControlPlan& plan) {
  ControlResult result{
      .seeds = plan.seeds, .first_seed = plan.first_seed, .times = plan.times, .cases = {}};
  for (const PathKind path : kPaths) {
    for (const Mishap mishap : kMishaps) {
      ControlCase& one = result.cases.emplace_back(ControlCase{path, mishap, {}});
      for (std::vector<MissionErrors>& flown : one.flown) {
        flown.resize(plan.seeds);
      }
    }
  }
  const NominalModel nominal(plan.vehicle);
  std::atomic<bool> stopped{false};
  std::mutex mutex;
  std::size_t done = 0;
  const double all = static_cast<double>(result.cases.size() * plan.seeds);
  std::vector<std::function<void()>> jobs;
  for (std::size_t seed = 0; seed < plan.seeds; ++seed) {
    const auto learned = std::make_shared<const DynamicsModel>(
        commissioned(plan.vehicle, plan.commissioning_s, plan.first_seed + seed));
    for (ControlCase& one : result.cases) {
      jobs.emplace_back([&, seed, learned] {
        for (const ControllerKind kind : kControllers) {
          if (stopped) {
            return;
          }
          const std::unique_ptr<Controller> controller = make_controller(kind, nominal, *learned);
          const Mission mission{one.path, one.mishap, plan.times, plan.first_seed + seed};
          one.flown[index_of(kind)][seed] = fly(plan.vehicle, mission, *controller);
        }
        const std::lock_guard lock(mutex);
        if (!plan.keep_going(static_cast<double>(++done) / all)) {
          stopped = true;
        }
      });
    }
  }
  jobs::run_all(jobs.size(), plan.threads, [&](std::size_t job) { jobs[job](); });
  result.interrupted = stopped;
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

}  // namespace kelpie::lab
