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
  std::string text = fmt::format(
      "-- Drive planned by `kelpie plan`: {:g} s, then rest. Put into APM/scripts, SCR_ENABLE 1.\n"
      "-- Begins when the vehicle is armed; disarm to stop. The pilot's sticks don't reach these\n"
      "-- motors meanwhile: no hold of depth. Clear water of {:g} m around the start is needed.\n"
      "local functions = {{",
      drive.plan.duration_s(), drive.bounds.radius_m);
  for (const std::string& thruster : drive.thrusters) {
    text += fmt::format("{}, ", motor_function(motor_number(thruster)));
  }
  text += "} -- SERVOn_FUNCTION\nlocal setpoints = { -- ms, then a pulse in us for each\n";
  each_setpoint(drive, [&](double t, const std::vector<double>& commands) {
    text += fmt::format("  {{{:.0f}", 1000.0 * t);
    for (const double command : commands) {
      text += fmt::format(", {:.0f}", std::clamp(command, 1100.0, 1900.0));
    }
    text += "},\n";
  });
  text += fmt::format(
      "}}\n"
      "local began = nil\n"
      "local at = 1\n"
      "local function drive()\n"
      "  if not arming:is_armed() then\n"
      "    began = nil\n"
      "    at = 1\n"
      "    return drive, 100\n"
      "  end\n"
      "  began = began or millis():toint()\n"
      "  local t = millis():toint() - began\n"
      "  while at < #setpoints and setpoints[at + 1][1] <= t do\n"
      "    at = at + 1\n"
      "  end\n"
      "  if at == #setpoints then\n"
      "    return drive, 100 -- the end: outputs are the autopilot's again\n"
      "  end\n"
      "  for i = 1, #functions do\n"
      "    local channel = SRV_Channels:find_channel(functions[i])\n"
      "    if channel then\n"
      "      SRV_Channels:set_output_pwm_chan_timeout(channel, setpoints[at][i + 1], {})\n"
      "    end\n"
      "  end\n"
      "  return drive, 50\n"
      "end\n"
      "gcs:send_text(6, \"kelpie plan: waiting for arming\")\n"
      "return drive, 1000\n",
      kHoldMs);
  return text;
}

}  // namespace kelpie::format
