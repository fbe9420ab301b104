// SPDX-License-Identifier: Apache-2.0
#include "console/demo.hpp"

#include <string>

#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "log/read_log.hpp"
#include "simulator/dagon.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/simulated_log.hpp"

namespace kelpie::cli {
namespace {

constexpr double kDamaged = 0.6;  // share of the thrust of th2

simulator::Scenario demo_scenario(double duration_s) {
  simulator::Scenario scenario;
  scenario.vehicle =
      simulator::read_vehicle(file::TomlNode::parse(std::string(simulator::kDagon), "dagon.toml"));
  scenario.rate_hz = 10.0;
  scenario.noise = simulator::noise_preset("as_recorded");
  simulator::Configuration nominal;
  nominal.name = "nominal";
  simulator::Configuration damaged;
  damaged.name = "damaged";
  damaged.effectiveness(simulator::kSurgeRight) = kDamaged;
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
        .table = study::log_table(simulator::simulate(demo_scenario(duration_s)), source),
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
