// SPDX-License-Identifier: Apache-2.0
#include "simulator/scenario_file.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "simulator/parameters.hpp"
#include "simulator/toml_matrix.hpp"

namespace kelpie::simulator {
namespace {

double number_or(const file::TomlNode& table, const std::string& key, double otherwise) {
  return table.has(key) ? table[key].number() : otherwise;
}

// What `make` turns the text into.
template <typename Make>
auto choice(const file::TomlNode& value, Make make) {
  const std::string text = value.text();
  return file::located(value, [&] { return make(text); });
}

void read_body(const file::TomlNode& root, VehicleParameters& vehicle) {
  const file::TomlNode body = root["body"].table({"mass_kg", "inertia_kg_m2", "centre_of_gravity_m",
                                                  "centre_of_buoyancy_m", "net_buoyancy_n"});
  vehicle.mass_kg = body["mass_kg"].number();
  vehicle.inertia_kg_m2 = read_square<3>(body["inertia_kg_m2"]);
  vehicle.centre_of_gravity_m = read_vector<3>(body["centre_of_gravity_m"]);
  vehicle.centre_of_buoyancy_m = read_vector<3>(body["centre_of_buoyancy_m"]);
  vehicle.net_buoyancy_n = body["net_buoyancy_n"].number();

  const file::TomlNode water =
      root["hydrodynamics"].table({"added_mass", "linear_damping", "quadratic_damping"});
  vehicle.added_mass = read_square<6>(water["added_mass"]);
  vehicle.linear_damping = read_vector<6>(water["linear_damping"]);
  vehicle.quadratic_damping = read_vector<6>(water["quadratic_damping"]);
}

Thruster read_thruster(const file::TomlNode& section, CommandUnit unit) {
  const bool is_speed = unit == CommandUnit::speed;
  std::vector<std::string> keys = {"forward", "reverse", "position_m", "direction", "dead_band"};
  if (is_speed) {
    keys.emplace_back("max_speed_rps");
  }
  section.table(keys);
  return {.forward = section["forward"].number(),
          .reverse = section["reverse"].number(),
          .position_m = read_vector<3>(section["position_m"]),
          .direction = read_vector<3>(section["direction"]),
          .max_speed_rps = is_speed ? section["max_speed_rps"].number() : 1.0,
          .dead_band = number_or(section, "dead_band", 0.0),
          .name = section.key()};
}

// In the order of the file, but for the thrusters of a drive in the plane, which has its own.
void read_thrusters(const file::TomlNode& root, VehicleParameters& vehicle) {
  for (const file::TomlNode& section : root["thrusters"].members()) {
    vehicle.thrusters.push_back(read_thruster(section, vehicle.command_unit));
  }
  const auto& planar = planar_thruster_names();
  const auto place = [&](const Thruster& thruster) {
    return std::ranges::find(planar, thruster.name) - planar.begin();
  };
  if (vehicle.thrusters.size() == planar.size() &&
      std::ranges::all_of(vehicle.thrusters, [&](const Thruster& thruster) {
        return place(thruster) < static_cast<std::ptrdiff_t>(planar.size());
      })) {
    std::ranges::sort(vehicle.thrusters, {}, place);
  }
}

HoldGains read_hold(const file::TomlNode& hold) {
  hold.table({"depth_p", "depth_i", "depth_d", "pitch_p", "pitch_d", "roll_p", "roll_d"});
  return {.depth_p = hold["depth_p"].number(),
          .depth_i = hold["depth_i"].number(),
          .depth_d = hold["depth_d"].number(),
          .pitch_p = hold["pitch_p"].number(),
          .pitch_d = hold["pitch_d"].number(),
          .roll_p = number_or(hold, "roll_p", 0.0),
          .roll_d = number_or(hold, "roll_d", 0.0)};
}

BatteryParameters read_battery(const file::TomlNode& battery) {
  battery.table({"nominal_v", "full_v", "empty_v", "resistance_ohm", "capacity_ah", "thruster_w",
                 "idle_w", "exponent"});
  BatteryParameters parameters{.nominal_v = battery["nominal_v"].number(),
                               .full_v = battery["full_v"].number(),
                               .empty_v = battery["empty_v"].number(),
                               .resistance_ohm = battery["resistance_ohm"].number(),
                               .capacity_ah = battery["capacity_ah"].number(),
                               .thruster_w = battery["thruster_w"].number(),
                               .idle_w = number_or(battery, "idle_w", 0.0),
                               .exponent = battery["exponent"].number()};
  if (parameters.nominal_v <= 0.0) {
    battery["nominal_v"].refuse("must be above zero");
  }
  return parameters;
}

void read_actuators(const file::TomlNode& root, VehicleParameters& vehicle) {
  const file::TomlNode rotors = root["rotors"].table({"command", "lag_s", "rate", "delay_s"});
  if (rotors.has("command")) {
    vehicle.command_unit = choice(rotors["command"], command_unit_from);
  }
  vehicle.rotor_lag_s = rotors["lag_s"].number();
  vehicle.rotor_rate = number_or(rotors, "rate", 0.0);
  vehicle.rotor_delay_s = number_or(rotors, "delay_s", 0.0);
  read_thrusters(root, vehicle);
  if (root.has("battery")) {
    vehicle.battery = read_battery(root["battery"]);
  }
  if (drives_in_plane(vehicle) || root.has("hold")) {
    vehicle.hold = read_hold(root["hold"]);
  }
}

Payload read_payload(const file::TomlNode& section) {
  Payload payload;
  payload.mass_kg = number_or(section, "mass_kg", 0.0);
  payload.buoyancy_n = number_or(section, "buoyancy_n", 0.0);
  if (section.has("position_m")) {
    payload.position_m = read_vector<3>(section["position_m"]);
  }
  if (section.has("inertia_kg_m2")) {
    payload.inertia_kg_m2 = read_square<3>(section["inertia_kg_m2"]);
  }
  if (section.has("added_mass")) {
    payload.added_mass = read_square<6>(section["added_mass"]);
  }
  return payload;
}

SensorFault read_sensors(const file::TomlNode& section) {
  SensorFault fault;
  for (const auto& [key, value] : {std::pair{"scale", &fault.scale}, std::pair{"bias", &fault.bias},
                                   std::pair{"frozen", &fault.frozen}}) {
    if (section.has(key)) {
      *value = read_vector<3>(section[key]);
    }
  }
  return fault;
}

Configuration read_configuration(const file::TomlNode& section,
                                 const std::vector<Thruster>& thrusters) {
  Configuration configuration;
  configuration.name = section["name"].text();
  if (section.has("effectiveness")) {
    std::vector<std::string> names;
    std::ranges::transform(thrusters, std::back_inserter(names), &Thruster::name);
    const file::TomlNode effectiveness = section["effectiveness"].table(names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      configuration.effectiveness(static_cast<Eigen::Index>(i)) =
          number_or(effectiveness, names[i], 1.0);
    }
  }
  if (section.has("damping_factor")) {
    configuration.damping_factor = read_vector<6>(section["damping_factor"]);
  }
  if (section.has("pull_n")) {
    configuration.pull_n = read_vector<3>(section["pull_n"]);
  }
  if (section.has("pull_position_m")) {
    configuration.pull_position_m = read_vector<3>(section["pull_position_m"]);
  }
  if (section.has("sensors")) {
    configuration.sensors = read_sensors(section["sensors"].table({"scale", "bias", "frozen"}));
  }
  if (section.has("payload")) {
    configuration.payload = read_payload(section["payload"].table(
        {"mass_kg", "position_m", "inertia_kg_m2", "added_mass", "buoyancy_n"}));
  }
  return configuration;
}

std::vector<Configuration> read_configurations(const file::TomlNode& root,
                                               const std::vector<Thruster>& thrusters) {
  std::vector<Configuration> configurations;
  for (const file::TomlNode& section :
       root["configurations"].tables({"name", "effectiveness", "damping_factor", "payload",
                                      "pull_n", "pull_position_m", "sensors"})) {
    Configuration configuration = read_configuration(section, thrusters);
    if (std::any_of(configurations.begin(), configurations.end(),
                    [&](const auto& other) { return other.name == configuration.name; })) {
      section["name"].refuse("'" + configuration.name + "' is the name of one before");
    }
    configurations.push_back(std::move(configuration));
  }
  return configurations;
}

std::size_t find_configuration(const file::TomlNode& section,
                               const std::vector<Configuration>& configurations) {
  const std::string name = section["configuration"].text();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    if (configurations[i].name == name) {
      return i;
    }
    names.push_back(configurations[i].name);
  }
  section["configuration"].refuse(unknown_name(name, "configuration", names));
}

void read_phases(const file::TomlNode& root, Scenario& scenario) {
  for (const file::TomlNode& section :
       root["phases"].tables({"configuration", "duration_s", "amplitude", "ramp_s"})) {
    scenario.phases.push_back(
        {.configuration = find_configuration(section, scenario.configurations),
         .duration_s = section["duration_s"].number(),
         .amplitude = number_or(section, "amplitude", 1.0),
         .ramp_s = number_or(section, "ramp_s", 0.0)});
  }
}

ExcitationSettings read_excitation(const file::TomlNode& section) {
  ExcitationSettings settings;
  if (section.has("mode")) {
    settings.mode = choice(section["mode"], excitation_mode_from);
  }
  if (section.has("period_s")) {
    const Eigen::Vector2d period = read_vector<2>(section["period_s"]);
    settings.shortest_period_s = period(0);
    settings.longest_period_s = period(1);
  }
  settings.correlation = number_or(section, "correlation", settings.correlation);
  settings.dither = number_or(section, "dither", settings.dither);
  for (const char* const key : {"effort", "dither"}) {
    if (settings.in_plane() && section.has(key)) {
      section[key].refuse("has no effect in this mode; prbs, steps and pilot use it");
    }
  }
  if (!settings.in_plane() && section.has("correlation")) {
    section["correlation"].refuse("has no effect in this mode; correlated uses it");
  }
  if (section.has("effort")) {
    settings.effort = read_vector<6>(section["effort"]);
  }
  return settings;
}

}  // namespace

VehicleParameters read_vehicle(const std::filesystem::path& file) {
  return read_vehicle(file::TomlNode::read(file));
}

VehicleParameters read_vehicle(const file::TomlNode& root) {
  root.table({"body", "hydrodynamics", "rotors", "thrusters", "battery", "hold"});
  VehicleParameters vehicle;
  read_body(root, vehicle);
  read_actuators(root, vehicle);
  root.locate_errors([&] { vehicle.validate(); });
  return vehicle;
}

Scenario read_scenario(const std::filesystem::path& file) {
  const file::TomlNode root = file::TomlNode::read(file);
  root.table({"vehicle", "seed", "rate_hz", "log", "noise", "current_m_s", "excitation",
              "configurations", "phases"});
  Scenario scenario;
  scenario.rate_hz = root["rate_hz"].number();
  if (root.has("seed")) {
    scenario.seed = root["seed"].count();
  }
  if (root.has("log")) {
    scenario.log = choice(root["log"], log_kind_from);
  }
  if (root.has("noise")) {
    scenario.noise = choice(root["noise"], noise_preset);
  }
  if (root.has("current_m_s")) {
    scenario.current_m_s = read_vector<3>(root["current_m_s"]);
  }
  if (root.has("excitation")) {
    scenario.excitation = read_excitation(
        root["excitation"].table({"mode", "period_s", "correlation", "effort", "dither"}));
  }
  const std::filesystem::path vehicle_file =
      (file.parent_path() / root["vehicle"].text()).lexically_normal();
  std::error_code error;  // of permissions: read_vehicle() tells
  if (!std::filesystem::exists(vehicle_file, error) && !error) {
    root["vehicle"].refuse("there is no file " + vehicle_file.string());
  }
  scenario.vehicle = read_vehicle(vehicle_file);
  scenario.configurations = read_configurations(root, scenario.vehicle.thrusters);
  read_phases(root, scenario);
  root.locate_errors([&] { scenario.validate(); });
  return scenario;
}

}  // namespace kelpie::simulator
