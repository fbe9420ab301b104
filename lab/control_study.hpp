// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lab/closed_loop.hpp"

namespace kelpie::lab {

/// The controllers.
enum class ControllerKind {
  pid,           ///< (a)
  feed_forward,  ///< (b)
  learned,       ///< (c)
  adaptive,      ///< (d)
};
inline constexpr std::array kControllers{ControllerKind::pid, ControllerKind::feed_forward,
                                         ControllerKind::learned, ControllerKind::adaptive};
std::string controller_name(ControllerKind kind);

/// The plan of a study: vehicle, seeds and lengths of the missions.
struct ControlPlan {
  vehicle::VehicleParameters vehicle;
  std::size_t seeds = 5;
  std::uint64_t first_seed = 1;
  MissionTimes times{};
  double commissioning_s = 600.0;  ///< learning time of (c) before its missions
  std::size_t threads = 0;         ///< 0: one per core
  /// Called now and then with the finished share; false stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };
};

/// The missions of one path and one mishap: [controller][seed].
struct ControlCase {
  PathKind path = PathKind::lawn_mower;
  Mishap mishap = Mishap::none;
  std::array<std::vector<MissionErrors>, kControllers.size()> flown{};
};

/// The largest ratio of the errors of (c) and (a), over seeds and phases.
double worst_against_pid(const ControlCase& one);

/// The results of a study.
struct ControlResult {
  std::size_t seeds = 0;
  std::uint64_t first_seed = 1;
  MissionTimes times{};
  std::vector<ControlCase> cases;
  bool interrupted = false;
};

/// Flies every path with every mishap under every controller. The same plan gives the same result.
ControlResult run_control(const ControlPlan& plan);

std::string control_table(const ControlResult& result);  ///< Errors per case, for a terminal.
std::string control_json(const ControlResult& result);   ///< All results (docs/control.md).

}  // namespace kelpie::lab
