// SPDX-License-Identifier: Apache-2.0
#include "cli/six_axis_log.hpp"

#include <algorithm>

namespace kelpie::cli {

void begin_six_axes(const SixAxisOptions& six, PlanOptions& options) {
  if (!six.volts.empty()) {
    options.log.also.push_back(six.volts);
  }
  body_frame(six.frame, false);
}

std::optional<SixAxisLog> six_axis_log(PlanOptions options, const SixAxisOptions& six,
                                       const vehicle::VehicleParameters& vehicle,
                                       std::string& why) {
  const bool find_times = options.align != "none";
  if (options.align == "auto") {
    options.align = "none";  // the fit finds lag and delay itself
  }
  SixAxisLog log{.plan = plan_log(options).plan, .columns = {}};
  const auto columns = study::six_axis_columns(log.plan.data, log.plan.settings.shared.states,
                                               vehicle, six.volts, why);
  if (!columns) {
    return std::nullopt;
  }
  log.columns = *columns;
  log.frame = body_frame(six.frame, true);
  log.neutral = log.plan.alignment.alignment.actuators.empty() ? kNeutralPulseUs : 0.0;
  log.how = {.start = {.lag_s = find_times ? 0.1 : 0.0}, .find_times = find_times};
  return log;
}

std::vector<std::pair<std::string, double>> of_full_commands(
    std::vector<std::pair<std::string, double>> thrusts,
    const vehicle::VehicleParameters& vehicle) {
  for (auto& [name, value] : thrusts) {
    const auto thruster = std::ranges::find(vehicle.thrusters, name, &vehicle::Thruster::name);
    if (thruster != vehicle.thrusters.end() &&
        vehicle.command_unit == vehicle::CommandUnit::speed) {
      value *= thruster->max_speed_rps * thruster->max_speed_rps;
    }
  }
  return thrusts;
}

}  // namespace kelpie::cli
