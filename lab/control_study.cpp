// SPDX-License-Identifier: Apache-2.0
#include "lab/control_study.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>

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

}  // namespace kelpie::lab
