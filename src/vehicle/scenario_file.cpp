// SPDX-License-Identifier: Apache-2.0
#include "vehicle/scenario_file.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "file/toml_section.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"
#include "vehicle/thrusters.hpp"

namespace kelpie::vehicle {
namespace {

std::vector<std::string> thruster_keys() {
  return {thruster_names().begin(), thruster_names().end()};
}

void read_body(const file::TomlSection& root, VehicleParameters& vehicle) {
  const file::TomlSection body =
      root.section("body", {"mass_kg", "inertia_kg_m2", "centre_of_gravity_m",
                            "centre_of_buoyancy_m", "net_buoyancy_n"});
  vehicle.mass_kg = body.number("mass_kg");
  vehicle.inertia_kg_m2 = body.square<3>("inertia_kg_m2");
  vehicle.centre_of_gravity_m = body.vector<3>("centre_of_gravity_m");
  vehicle.centre_of_buoyancy_m = body.vector<3>("centre_of_buoyancy_m");
  vehicle.net_buoyancy_n = body.number("net_buoyancy_n");

  const file::TomlSection water =
      root.section("hydrodynamics", {"added_mass", "linear_damping", "quadratic_damping"});
  vehicle.added_mass = water.square<6>("added_mass");
  vehicle.linear_damping = water.vector<6>("linear_damping");
  vehicle.quadratic_damping = water.vector<6>("quadratic_damping");
}

void read_actuators(const file::TomlSection& root, VehicleParameters& vehicle) {
  vehicle.rotor_lag_s = root.section("rotors", {"lag_s"}).number("lag_s");
  const file::TomlSection thrusters = root.section("thrusters", thruster_keys());
  for (std::size_t i = 0; i < kThrusterCount; ++i) {
    const file::TomlSection section = thrusters.section(
        thruster_names()[i], {"forward", "reverse", "position_m", "direction", "max_speed_rps"});
    vehicle.thrusters[i] = {.forward = section.number("forward"),
                            .reverse = section.number("reverse"),
                            .position_m = section.vector<3>("position_m"),
                            .direction = section.vector<3>("direction"),
                            .max_speed_rps = section.number("max_speed_rps")};
  }
  const file::TomlSection hold =
      root.section("hold", {"depth_p", "depth_i", "depth_d", "pitch_p", "pitch_d"});
  vehicle.hold = {.depth_p = hold.number("depth_p"),
                  .depth_i = hold.number("depth_i"),
                  .depth_d = hold.number("depth_d"),
                  .pitch_p = hold.number("pitch_p"),
                  .pitch_d = hold.number("pitch_d")};
}

Payload read_payload(const file::TomlSection& section) {
  Payload payload;
  payload.mass_kg = section.number("mass_kg", 0.0);
  payload.buoyancy_n = section.number("buoyancy_n", 0.0);
  if (section.has("position_m")) {
    payload.position_m = section.vector<3>("position_m");
  }
  if (section.has("inertia_kg_m2")) {
    payload.inertia_kg_m2 = section.square<3>("inertia_kg_m2");
  }
  if (section.has("added_mass")) {
    payload.added_mass = section.square<6>("added_mass");
  }
  return payload;
}

Configuration read_configuration(const file::TomlSection& section) {
  Configuration configuration;
  configuration.name = section.text("name");
  if (section.has("effectiveness")) {
    const file::TomlSection effectiveness = section.section("effectiveness", thruster_keys());
    for (std::size_t i = 0; i < kThrusterCount; ++i) {
      configuration.effectiveness(static_cast<Eigen::Index>(i)) =
          effectiveness.number(thruster_names()[i], 1.0);
    }
  }
  if (section.has("damping_factor")) {
    configuration.damping_factor = section.vector<6>("damping_factor");
  }
  if (section.has("payload")) {
    configuration.payload = read_payload(section.section(
        "payload", {"mass_kg", "position_m", "inertia_kg_m2", "added_mass", "buoyancy_n"}));
  }
  return configuration;
}

std::vector<Configuration> read_configurations(const file::TomlSection& root) {
  std::vector<Configuration> configurations;
  for (const file::TomlSection& section :
       root.sections("configurations", {"name", "effectiveness", "damping_factor", "payload"})) {
    Configuration configuration = read_configuration(section);
    if (std::any_of(configurations.begin(), configurations.end(),
                    [&](const auto& other) { return other.name == configuration.name; })) {
      section.reject("name", "'" + configuration.name + "' is the name of one before");
    }
    configurations.push_back(std::move(configuration));
  }
  return configurations;
}

std::size_t find_configuration(const file::TomlSection& section,
                               const std::vector<Configuration>& configurations) {
  const std::string name = section.text("configuration");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    if (configurations[i].name == name) {
      return i;
    }
    names.push_back(configurations[i].name);
  }
  section.reject("configuration", "there is no configuration '" + name + "'" +
                                      did_you_mean(name, names) + "; there are " +
                                      join_text(names, ", "));
}

void read_phases(const file::TomlSection& root, Scenario& scenario) {
  for (const file::TomlSection& section :
       root.sections("phases", {"configuration", "duration_s", "amplitude", "ramp_s"})) {
    scenario.phases.push_back(
        {.configuration = find_configuration(section, scenario.configurations),
         .duration_s = section.number("duration_s"),
         .amplitude = section.number("amplitude", 1.0),
         .ramp_s = section.number("ramp_s", 0.0)});
  }
}

// What `make` turns the text under `key` into; what it throws is told with the key's place.
template <typename Make>
auto choice(const file::TomlSection& section, const std::string& key, Make make) {
  const std::string text = section.text(key);
  try {
    return make(text);
  } catch (const InputError& error) {
    section.reject(key, error.what());
  }
}

ExcitationSettings read_excitation(const file::TomlSection& section) {
  ExcitationSettings settings;
  if (section.has("mode")) {
    settings.mode = choice(section, "mode", excitation_mode_from);
  }
  if (section.has("period_s")) {
    const Eigen::Vector2d period = section.vector<2>("period_s");
    settings.shortest_period_s = period(0);
    settings.longest_period_s = period(1);
  }
  settings.correlation = section.number("correlation", settings.correlation);
  return settings;
}

}  // namespace

VehicleParameters read_vehicle(const std::filesystem::path& file) {
  const toml::table table = file::parse_toml(file);
  const file::TomlSection root(table, file.string(), "",
                               {"body", "hydrodynamics", "rotors", "thrusters", "hold"});
  VehicleParameters vehicle;
  read_body(root, vehicle);
  read_actuators(root, vehicle);
  file::locate_errors(table, file.string(), [&] { vehicle.validate(); });
  return vehicle;
}

Scenario read_scenario(const std::filesystem::path& file) {
  const toml::table table = file::parse_toml(file);
  const file::TomlSection root(table, file.string(), "",
                               {"vehicle", "seed", "rate_hz", "noise", "current_m_s", "excitation",
                                "configurations", "phases"});
  Scenario scenario;
  scenario.rate_hz = root.number("rate_hz");
  if (root.has("seed")) {
    scenario.seed = root.count("seed");
  }
  if (root.has("noise")) {
    scenario.noise = choice(root, "noise", noise_preset);
  }
  if (root.has("current_m_s")) {
    scenario.current_m_s = root.vector<3>("current_m_s");
  }
  if (root.has("excitation")) {
    scenario.excitation =
        read_excitation(root.section("excitation", {"mode", "period_s", "correlation"}));
  }
  scenario.configurations = read_configurations(root);
  read_phases(root, scenario);

  const std::filesystem::path vehicle_file =
      (file.parent_path() / root.text("vehicle")).lexically_normal();
  if (!std::filesystem::exists(vehicle_file)) {
    root.reject("vehicle", "there is no file " + vehicle_file.string());
  }
  scenario.vehicle = read_vehicle(vehicle_file);
  file::locate_errors(table, file.string(), [&] { scenario.validate(); });
  return scenario;
}

}  // namespace kelpie::vehicle
