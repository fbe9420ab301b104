// SPDX-License-Identifier: Apache-2.0
#include "console/demo.hpp"

#include <string>

#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "log/read_log.hpp"
#include "study/simulated_log.hpp"
#include "vehicle/dagon.hpp"
#include "vehicle/scenario_file.hpp"
#include "vehicle/simulation.hpp"

namespace kelpie::cli {
namespace {

constexpr double kDamaged = 0.6;  // share of the thrust of th2

vehicle::Scenario demo_scenario(double duration_s) {
  vehicle::Scenario scenario;
  scenario.vehicle =
      vehicle::read_vehicle(file::TomlNode::parse(std::string(vehicle::kDagon), "dagon.toml"));
  scenario.rate_hz = 10.0;
  scenario.noise = vehicle::noise_preset("as_recorded");
  vehicle::Configuration nominal;
  nominal.name = "nominal";
  vehicle::Configuration damaged;
  damaged.name = "damaged";
  damaged.effectiveness(vehicle::kSurgeRight) = kDamaged;
  scenario.configurations = {nominal, damaged};
  scenario.phases = {{.configuration = 0, .duration_s = duration_s / 2.0},
                     {.configuration = 1, .duration_s = duration_s / 2.0}};
  return scenario;
}

}  // namespace

log::Dataset demo_rows(double duration_s) {
  const std::string source = "the simulated vehicle";
  try {
    const log::Log log{
        .table = study::log_table(vehicle::simulate(demo_scenario(duration_s)), source),
        .roles = {.units = {{"u", "m/s"},
                            {"v", "m/s"},
                            {"r", "rad/s"},
                            {"udot", "m/s^2"},
                            {"vdot", "m/s^2"},
                            {"rdot", "rad/s^2"}}}};
    return log.dataset();
  } catch (const InputError& error) {
    throw InputError("--duration", error.what());
  }
}

}  // namespace kelpie::cli
