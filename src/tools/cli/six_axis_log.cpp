// SPDX-License-Identifier: Apache-2.0
#include "cli/six_axis_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/options.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::cli {

void begin_six_axes(const SixAxisOptions& six, PlanOptions& options) {
  options.log.has_curves = true;
  if (!six.volts.empty()) {
    options.log.also.push_back(six.volts);
  }
  body_frame(six.frame, false);
}

std::string identification_text(const IdentificationOptions& options, const SixAxisOptions& six) {
  std::string text = options.learning_text(options.config);
  const auto add = [&](const char* option, const std::string& value) {
    text += value.empty() ? "" : fmt::format(" {} {}", option, shell_word(value));
  };
  add("--thrusters", join_text(options.thrusters, ","));
  for (const std::string& thrust : options.thrust) {
    add("--thrust", thrust);
  }
  add("--only", options.only ? std::to_string(*options.only) : "");
  add("--vehicle", six.vehicle);
  add("--volts", six.volts);
  add("--frame", six.frame);
  return text;
}

void refuse_volts_in_plane(const SixAxisOptions& six) {
  require(six.volts.empty(), "--volts",
          "has no effect in the plane, where thrust does not follow the supply: it is for six "
          "axes, which take --vehicle with the places of the log's thrusters; remove --volts");
}

std::optional<SixAxisLog> six_axis_log(PlanOptions options, const SixAxisOptions& six,
                                       const simulator::VehicleParameters& vehicle,
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
    const simulator::VehicleParameters& vehicle) {
  for (auto& [name, value] : thrusts) {
    const auto thruster = std::ranges::find(vehicle.thrusters, name, &simulator::Thruster::name);
    if (thruster != vehicle.thrusters.end() &&
        vehicle.command_unit == simulator::CommandUnit::speed) {
      value *= thruster->max_speed_rps * thruster->max_speed_rps;
    }
  }
  return thrusts;
}

}  // namespace kelpie::cli
