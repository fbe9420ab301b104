// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/fleet.hpp"

namespace kelpie::lab {

/// For a terminal.
std::string fleet_table(const FleetPlan& plan, const FleetResult& result);
std::string schedule_table(const FleetTimes& times, const std::vector<FleetSchedule>& schedules);

/// Everything as JSON (docs/fleet.md).
std::string fleet_json(const FleetPlan& plan, const FleetResult& result);
std::string schedule_json(const FleetTimes& times, const std::vector<FleetSchedule>& schedules);

}  // namespace kelpie::lab
