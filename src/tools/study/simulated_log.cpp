// SPDX-License-Identifier: Apache-2.0
#include "study/simulated_log.hpp"

#include <array>
#include <cstddef>

namespace kelpie::study {
namespace {

// Columns of a row, in the order of six_axis_names().
std::vector<double> cells_of(const simulator::SixAxisRow& row, bool has_battery) {
  std::vector<double> cells{row.t_s, static_cast<double>(row.configuration)};
  cells.insert(cells.end(), row.velocity.begin(), row.velocity.end());
  cells.insert(cells.end(), row.attitude_rad.begin(), row.attitude_rad.end());
  cells.insert(cells.end(), row.commands.begin(), row.commands.end());
  if (has_battery) {
    cells.push_back(row.voltage_v);
  }
  cells.insert(cells.end(), row.acceleration.begin(), row.acceleration.end());
  cells.insert(cells.end(), row.true_acceleration.begin(), row.true_acceleration.end());
  return cells;
}

std::string unit_of(simulator::CommandUnit unit) {
  constexpr std::array kUnits{" [rev/s]", "", " [us]"};
  return kUnits.at(static_cast<std::size_t>(unit));
}

std::vector<std::string> six_axis_names(const simulator::VehicleParameters& vehicle) {
  std::vector<std::string> names{"t [s]",     "conf",        "u [m/s]",   "v [m/s]",
                                 "w [m/s]",   "p [rad/s]",   "q [rad/s]", "r [rad/s]",
                                 "phi [rad]", "theta [rad]", "psi [rad]"};
  for (const simulator::Thruster& thruster : vehicle.thrusters) {
    names.push_back(thruster.name + unit_of(vehicle.command_unit));
  }
  if (vehicle.battery.nominal_v > 0.0) {
    names.emplace_back("voltage [V]");
  }
  for (const char* const ending : {"", "_true"}) {
    for (const char* const axis : {"udot", "vdot", "wdot", "pdot", "qdot", "rdot"}) {
      const bool is_linear = std::string("uvw").find(axis[0]) != std::string::npos;
      names.push_back(std::string(axis) + ending + (is_linear ? " [m/s^2]" : " [rad/s^2]"));
    }
  }
  return names;
}

}  // namespace

log::Table log_table(std::span<const simulator::LogRow> rows, const std::string& source) {
  log::Table table;
  table.source = source;
  table.names = {"t",   "conf", "u",    "v",    "r",         "th1",       "th2",
                 "th3", "udot", "vdot", "rdot", "udot_true", "vdot_true", "rdot_true"};
  table.columns.resize(table.names.size());
  for (const simulator::LogRow& row : rows) {
    std::size_t column = 0;
    table.columns[column++].push_back(row.t_s);
    table.columns[column++].push_back(static_cast<double>(row.configuration));
    for (const Eigen::Vector3d* const values :
         {&row.velocity, &row.rotors_rps, &row.acceleration, &row.true_acceleration}) {
      for (const double value : *values) {
        table.columns[column++].push_back(value);
      }
    }
    table.lines.push_back(table.lines.size() + 2);  // below the header
  }
  return table;
}

log::Table log_table(std::span<const simulator::SixAxisRow> rows,
                     const simulator::VehicleParameters& vehicle, const std::string& source) {
  log::Table table;
  table.source = source;
  table.names = six_axis_names(vehicle);
  table.columns.resize(table.names.size());
  for (const simulator::SixAxisRow& row : rows) {
    const std::vector<double> cells = cells_of(row, vehicle.battery.nominal_v > 0.0);
    for (std::size_t column = 0; column < cells.size(); ++column) {
      table.columns[column].push_back(cells[column]);
    }
    table.lines.push_back(table.lines.size() + 2);  // below the header
  }
  return table;
}

}  // namespace kelpie::study
