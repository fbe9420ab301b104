// SPDX-License-Identifier: Apache-2.0
#include "format/drive_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "file/json.hpp"
#include "kelpie/core/setting.hpp"

namespace kelpie::format {
namespace {

constexpr double kLeastRest = 1400.0;  // µs, of a pulse at rest
constexpr double kMostRest = 1600.0;
constexpr int kHoldMs = 300;  // of an output without a further command

// Instructions of a run of the script: ArduPilot's default of SCR_VM_I_COUNT, and those of loading
// beside the setpoints, with room.
constexpr std::size_t kUsualSteps = 10000;
constexpr std::size_t kScriptSteps = 200;

// After the tables `functions` and `setpoints`. A vehicle that is armed when the script is loaded,
// as after a restart of scripting under way, isn't driven.
constexpr const char* kDriveScript = R"(local channels = {}
local began
local at
local wait_for_disarming, wait_for_arming, drive

local function put_out(row)
  for i = 1, #channels do
    SRV_Channels:set_output_pwm_chan_timeout(channels[i], setpoints[row][i + 1], hold_ms)
  end
end

wait_for_disarming = function()
  if arming:is_armed() then
    return wait_for_disarming, 100
  end
  gcs:send_text(6, "kelpie plan: begins when armed")
  return wait_for_arming, 100
end

wait_for_arming = function()
  if not arming:is_armed() then
    return wait_for_arming, 100
  end
  for i = 1, #functions do
    channels[i] = SRV_Channels:find_channel(functions[i])
    if not channels[i] then
      gcs:send_text(3, "kelpie plan: no SERVOn_FUNCTION is " .. functions[i])
      return wait_for_disarming, 100
    end
  end
  gcs:send_text(6, "kelpie plan: begins")
  began = millis():toint()
  at = 1
  return drive()
end

drive = function()
  local t = millis():toint() - began
  while at < #setpoints and setpoints[at + 1][1] <= t do
    at = at + 1
  end
  if at < #setpoints and arming:is_armed() then
    put_out(at)
    return drive, math.min(50, setpoints[at + 1][1] - t)
  end
  put_out(#setpoints) -- at rest; then the outputs are the autopilot's again
  gcs:send_text(6, at < #setpoints and "kelpie plan: stopped" or "kelpie plan: at its end")
  return wait_for_disarming, 100
end

return wait_for_disarming, 1000
)";

// SERVOn_FUNCTION of ArduPilot's motors: motor 1 has 33, motor 9 has 82.
constexpr int kLastMotor = 12;
constexpr int motor_function(int motor) {
  return motor <= 8 ? 32 + motor : 73 + motor;
}

// The digits at the end of a name, or those before "_raw": 0 without.
int motor_number(const std::string& name) {
  const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
  const auto last = std::find_if(name.rbegin(), name.rend(), is_digit);
  int number = 0;
  int place = 1;
  for (auto digit = last; digit != name.rend() && is_digit(*digit) && place < 1000; ++digit) {
    number += place * (*digit - '0');
    place *= 10;
  }
  return number;
}

// Calls take(t, commands) for every setpoint, and for the rest at the end.
template <typename Take>
void each_setpoint(const PlannedDrive& drive, Take take) {
  double t = 0.0;
  std::vector<double> commands(drive.thrusters.size());
  for (const study::Manoeuvre& manoeuvre : drive.plan.manoeuvres) {
    for (const study::HeldSpeeds& part : manoeuvre.parts) {
      for (std::size_t i = 0; i < commands.size(); ++i) {
        commands[i] = drive.command(i, part.speeds[i]);
      }
      take(t, commands);
      t += part.duration_s;
    }
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    commands[i] = drive.command(i, 0.0);
  }
  take(t, commands);
}

file::Json moment_json(const study::DriveMoment& moment) {
  return {{"t_s", moment.t_s},
          {"manoeuvre", file::text_or_null(moment.manoeuvre)},
          {"numbers", file::numbers(moment.numbers)}};
}

file::Json manoeuvre_json(const study::Manoeuvre& manoeuvre) {
  return {
      {"name", manoeuvre.name},
      {"parts", file::list(manoeuvre.parts, [](const study::HeldSpeeds& part) {
         return file::Json{{"duration_s", part.duration_s}, {"speeds", file::numbers(part.speeds)}};
       })}};
}

}  // namespace

std::string drive_csv(const PlannedDrive& drive) {
  std::string text = "t";
  for (const std::string& thruster : drive.thrusters) {
    text += "," + thruster;
  }
  text += "\n";
  each_setpoint(drive, [&](double t, const std::vector<double>& commands) {
    text += number_text(t);
    for (const double command : commands) {
      text += fmt::format(",{:.6g}", command);
    }
    text += "\n";
  });
  return text;
}

std::string drive_json(const PlannedDrive& drive) {
  const study::DrivePlan& plan = drive.plan;
  file::Json document = {{"format", "kelpie-plan"},
                         {"version", 1},
                         {"log", drive.source},
                         {"bounds",
                          {{"time_s", drive.bounds.time_s},
                           {"speed_m_s", drive.bounds.speed_m_s},
                           {"radius_m", drive.bounds.radius_m}}},
                         {"number", drive.parts ? "nats" : "half width of 90 % over the size"},
                         {"aim", drive.aim},
                         {"reached", plan.reached},
                         {"duration_s", plan.duration_s()},
                         {"farthest_m", plan.extent.farthest_m},
                         {"fastest_m_s", plan.extent.fastest_m_s}};
  if (drive.six_axes) {
    document["bounds"]["depth_m"] = drive.bounds.depth_m;
    document["bounds"]["tilt_rad"] = drive.bounds.tilt_rad;
    document["depth_m"] = plan.extent.depth_m;
    document["tilt_rad"] = plan.extent.tilt_rad;
  }
  document["names"] = plan.names;
  document["countdown"] = file::list(plan.countdown, moment_json);
  document["thrusters"] = drive.thrusters;
  document["manoeuvres"] = file::list(plan.manoeuvres, manoeuvre_json);
  return file::json_text(document);
}

bool has_pulses(const PlannedDrive& drive) {
  std::set<int> motors;
  for (std::size_t i = 0; i < drive.thrusters.size(); ++i) {
    const double rest = drive.command(i, 0.0);
    const int motor = motor_number(drive.thrusters[i]);
    if (rest < kLeastRest || rest > kMostRest || motor == 0 || motor > kLastMotor ||
        !motors.insert(motor).second) {
      return false;
    }
  }
  return true;
}

std::string drive_lua(const PlannedDrive& drive) {
  std::string setpoints;
  std::size_t steps = kScriptSteps;
  each_setpoint(drive, [&](double t, const std::vector<double>& commands) {
    setpoints += fmt::format("  {{{:.0f}", 1000.0 * t);
    for (const double command : commands) {
      setpoints += fmt::format(", {:.0f}", std::clamp(command, 1100.0, 1900.0));
    }
    setpoints += "},\n";
    steps += commands.size() + 4;
  });
  std::string functions;
  for (const std::string& thruster : drive.thrusters) {
    functions += fmt::format("{}, ", motor_function(motor_number(thruster)));
  }
  return fmt::format(
             "-- Drive planned by `kelpie plan`: {:g} s, then rest. Put into APM/scripts;\n"
             "-- SCR_ENABLE 1, SCR_VM_I_COUNT {} or more.\n"
             "-- Begins at every arming from now on; disarm to stop. The pilot's sticks don't\n"
             "-- reach these motors meanwhile: no hold of depth. Clear water of {:g} m around the\n"
             "-- start is needed.\n"
             "local functions = {{{}}} -- SERVOn_FUNCTION\n"
             "local setpoints = {{ -- ms, then a pulse in us for each\n{}}}\n"
             "local hold_ms = {} -- of a pulse without a further one\n",
             drive.plan.duration_s(), std::max(steps, kUsualSteps), drive.bounds.radius_m,
             functions, setpoints, kHoldMs) +
         kDriveScript;
}

}  // namespace kelpie::format
