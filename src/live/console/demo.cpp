// SPDX-License-Identifier: Apache-2.0
#include "console/demo.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

// The next rows of a drive, at most ten seconds of them.
std::optional<log::Dataset> next_rows(const simulator::RowSource& drive) {
  constexpr std::size_t kMost = 100;
  std::vector<simulator::LogRow> rows;
  while (rows.size() < kMost) {
    std::optional<simulator::LogRow> row = drive();
    if (!row) {
      break;
    }
    rows.push_back(std::move(*row));
  }
  if (rows.empty()) {
    return std::nullopt;
  }
  const log::Log log{.table = study::log_table(rows, "the simulated vehicle"),
                     .roles = {.units = {{"u", "m/s"},
                                         {"v", "m/s"},
                                         {"r", "rad/s"},
                                         {"udot", "m/s^2"},
                                         {"vdot", "m/s^2"},
                                         {"rdot", "rad/s^2"}}}};
  return log.dataset();
}

}  // namespace

live::Configuration demo_configuration(double duration_s, const std::filesystem::path& file,
                                       const std::vector<std::string>& set) {
  simulator::RowSource drive;
  try {
    drive = simulator::drive_in_plane(demo_scenario(duration_s));
  } catch (const InputError& error) {
    throw InputError("--duration", error.what());
  }
  live::Configuration configuration = live::rows_configuration(next_rows(drive).value(), file, set);
  configuration.further = std::make_shared<live::FurtherRows>(
      live::FurtherRows{.end_s = duration_s, .next = [drive] { return next_rows(drive); }});
  return configuration;
}

}  // namespace kelpie::cli
