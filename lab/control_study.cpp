// SPDX-License-Identifier: Apache-2.0
#include "lab/control_study.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "chart/text_table.hpp"
#include "file/json.hpp"
#include "jobs/run_all.hpp"
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

std::string case_title(const ControlCase& one) {
  return path_name(one.path) + ", " + mishap_name(one.mishap);
}

std::string millimetres(double metres) {
  return fmt::format("{:.1f}", 1e3 * metres);
}

chart::TextTable errors_table(const ControlResult& result) {
  chart::TextTable table{
      fmt::format("Distance to where the vehicle should be, root mean square in mm, mean of {} "
                  "seeds (simulation): before / during / after",
                  result.seeds),
      {"mission"},
      {}};
  for (const ControllerKind kind : kControllers) {
    table.head.push_back(controller_name(kind));
  }
  table.head.emplace_back("worst (c)/(a)");
  for (const ControlCase& one : result.cases) {
    std::vector<std::string>& row = table.rows.emplace_back(1, case_title(one));
    for (const ControllerKind kind : kControllers) {
      row.push_back(millimetres(mean_error(one, kind, &MissionErrors::before)) + " / " +
                    millimetres(mean_error(one, kind, &MissionErrors::during)) + " / " +
                    millimetres(mean_error(one, kind, &MissionErrors::after)));
    }
    row.push_back(fmt::format("{:.2f}", worst_against_pid(one)));
  }
  table.whole = true;
  return table;
}

file::Json case_json(const ControlCase& one) {
  file::Json controllers = file::Json::array();
  for (std::size_t i = 0; i < kControllers.size(); ++i) {
    std::vector<double> before;
    std::vector<double> during;
    std::vector<double> after;
    std::vector<double> fallback;
    for (const MissionErrors& errors : one.flown[i]) {
      before.push_back(errors.before);
      during.push_back(errors.during);
      after.push_back(errors.after);
      fallback.push_back(errors.fallback_share);
    }
    controllers.push_back({{"name", controller_name(kControllers[i])},
                           {"before_m", file::numbers(before)},
                           {"during_m", file::numbers(during)},
                           {"after_m", file::numbers(after)},
                           {"fallback_share", file::numbers(fallback)},
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

double mean_error(const ControlCase& one, ControllerKind kind, double MissionErrors::*phase) {
  const std::vector<MissionErrors>& flown = one.flown[index_of(kind)];
  double sum = 0.0;
  for (const MissionErrors& errors : flown) {
    sum += errors.*phase;
  }
  return sum / static_cast<double>(flown.size());
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
  return chart::table_text(errors_table(result));
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
