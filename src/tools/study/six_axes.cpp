// SPDX-License-Identifier: Apache-2.0
#include "study/six_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "core/quantile.hpp"
#include "kelpie/core/error.hpp"
#include "motion/signal_names.hpp"
#include "motion/states.hpp"
#include "simulator/dynamics.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

constexpr double kPulsePerShareUs = 400.0;  // ArduSub: 1100 to 1900 µs

std::vector<PlacedThruster> placed_thrusters(const simulator::VehicleParameters& vehicle) {
  std::vector<PlacedThruster> thrusters;
  for (const simulator::Thruster& thruster : vehicle.thrusters) {
    const Eigen::Vector3d& p = thruster.position_m;
    const Eigen::Vector3d& d = thruster.direction;
    thrusters.push_back({.name = thruster.name,
                         .position_m = {p.x(), p.y(), p.z()},
                         .direction = {d.x(), d.y(), d.z()}});
  }
  return thrusters;
}

std::string missing_velocity(const log::Dataset& data, const std::vector<std::size_t>& states,
                             SixAxisColumns& columns) {
  constexpr std::array kNames{"surge", "sway", "heave", "roll rate", "pitch rate", "yaw rate"};
  for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
    const auto place = std::ranges::find_if(
        states, [&](std::size_t input) { return velocity_axis(data.input_names[input]) == axis; });
    if (place == states.end()) {
      return std::string("no ") + kNames[axis] + " with its acceleration";
    }
    columns.velocities[axis] = *place;
    columns.targets[axis] = static_cast<std::size_t>(place - states.begin());
  }
  return "";
}

// Of another unit, as mV, a power of the voltage would be numbers without a meaning.
void require_volts(const log::Dataset& data, const SixAxisColumns& columns, double nominal_v,
                   std::vector<double> volts) {
  if (volts.empty() || nominal_v <= 0.0) {
    return;
  }
  const double usual = quantile(volts, 0.5);
  if (!(usual < kTuning.most_supply_ratio * nominal_v) ||
      usual < nominal_v / kTuning.most_supply_ratio) {
    throw InputError(
        "--volts", fmt::format("'{}' is usually {:.4g}, the vehicle file's voltage is {:.4g} V; a "
                               "column in mV becomes V by voltage = 0.001 under [log.scale] of "
                               "--config",
                               data.input_names[*columns.volts], usual, nominal_v));
  }
}

void judge_six_axes(const log::Dataset& data, const std::vector<std::size_t>& rows,
                    const SixAxisColumns& columns, const SixAxisRows& six, Identification& found) {
  const SixAxisFit& fit = *found.six;
  const std::vector<double> speeds = thruster_speeds(six, fit.curve);
  const std::size_t count = six.thrusters.size();
  HeldOutFit& held_out = found.held_out;
  held_out = HeldOutFit(kSixAxes);
  held_out.times_s = six.times_s;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto velocity = std::span(six.velocities).subspan(kSixAxes * row).first<kSixAxes>();
    const auto down = std::span(six.down).subspan(3 * row).first<3>();
    const auto speed = std::span(speeds).subspan(count * row, count);
    const SixVector tied = fit.acceleration(velocity, down, speed);
    const SixVector untied = fit.free_acceleration(velocity, down, speed);
    for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
      held_out.measured[axis].push_back(data.target(rows[row])[columns.targets[axis]]);
      held_out.structure[axis].push_back(tied[axis]);
      held_out.free[axis].push_back(untied[axis]);
    }
  }
}

}  // namespace

std::array<double, 3> down_of(const Attitude& attitude, std::span<const double> inputs,
                              Frame frame) {
  const double flip = frame == Frame::flu ? -1.0 : 1.0;  // of pitch, and of a quaternion's y and z
  if (attitude.quaternion) {
    const auto [x, y, z, w] = *attitude.quaternion;
    const Triple down =
        in_body(Triple{0.0, 0.0, 1.0},
                std::array{inputs[w], inputs[x], flip * inputs[y], flip * inputs[z]});
    return down;
  }
  const double roll = attitude.roll ? attitude.roll_unit * inputs[*attitude.roll] : 0.0;
  const double pitch = attitude.pitch ? flip * attitude.pitch_unit * inputs[*attitude.pitch] : 0.0;
  return {-std::sin(pitch), std::cos(pitch) * std::sin(roll), std::cos(pitch) * std::cos(roll)};
}

double command_share(const simulator::VehicleParameters& vehicle, std::size_t thruster,
                     double command, double neutral) {
  switch (vehicle.command_unit) {
    case simulator::CommandUnit::pwm:
      return (command - neutral) / kPulsePerShareUs;
    case simulator::CommandUnit::share:
      return command;
    case simulator::CommandUnit::speed:
      break;
  }
  return command / vehicle.thrusters[thruster].max_speed_rps;
}

double command_for_share(const simulator::VehicleParameters& vehicle, std::size_t thruster,
                         double share, double neutral) {
  switch (vehicle.command_unit) {
    case simulator::CommandUnit::pwm:
      return neutral + kPulsePerShareUs * share;
    case simulator::CommandUnit::share:
      return share;
    case simulator::CommandUnit::speed:
      break;
  }
  return share * vehicle.thrusters[thruster].max_speed_rps;
}

std::optional<SixAxisColumns> six_axis_columns(const log::Dataset& data, const std::string& states,
                                               const simulator::VehicleParameters& vehicle,
                                               const std::string& volts, std::string& why) {
  SixAxisColumns columns;
  why = missing_velocity(data, find_states(states, data.input_names, data.target_names.size()),
                         columns);
  columns.attitude = find_attitude(data.input_names);
  if (!columns.attitude.quaternion && !(columns.attitude.roll && columns.attitude.pitch)) {
    why = "no roll and pitch";
  }
  for (const simulator::Thruster& thruster : vehicle.thrusters) {
    const std::optional<std::size_t> found = data.find_input(thruster.name);
    if (!found) {
      why = "no command of the vehicle file's thruster '" + thruster.name + "'";
      break;
    }
    columns.thrusters.push_back(*found);
  }
  if (!volts.empty()) {
    columns.volts = data.require_input_of("--volts", volts);
  }
  return why.empty() ? std::optional(columns) : std::nullopt;
}

SixAxisRows six_axis_rows(const log::Dataset& data, const std::vector<std::size_t>& rows,
                          const SixAxisColumns& columns,
                          const simulator::VehicleParameters& vehicle, Frame frame,
                          double neutral) {
  SixAxisRows six;
  six.starts.clear();
  six.thrusters = placed_thrusters(vehicle);
  six.nominal_volts = vehicle.battery.nominal_v > 0.0 ? vehicle.battery.nominal_v : 1.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t row = rows[i];
    if (i == 0 || !log::follows(data, rows[i - 1], row)) {
      six.starts.push_back(i);
    }
    const std::span<const double> inputs = data.input(row);
    six.times_s.push_back(data.times_s[row]);
    for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
      six.velocities.push_back(sign_in_frd(frame, axis) * inputs[columns.velocities[axis]]);
    }
    const std::array<double, 3> down = down_of(columns.attitude, inputs, frame);
    six.down.insert(six.down.end(), down.begin(), down.end());
    for (std::size_t k = 0; k < columns.thrusters.size(); ++k) {
      six.commands.push_back(command_share(vehicle, k, inputs[columns.thrusters[k]], neutral));
    }
    if (columns.volts) {
      six.volts.push_back(inputs[*columns.volts]);
    }
  }
  require_volts(data, columns, vehicle.battery.nominal_v, six.volts);
  return six;
}

SixAxisRows six_axis_rows(const std::vector<simulator::SixAxisRow>& log,
                          const simulator::VehicleParameters& vehicle) {
  SixAxisRows rows{.thrusters = placed_thrusters(vehicle)};
  const bool has_battery = vehicle.battery.nominal_v > 0.0;
  rows.nominal_volts = has_battery ? vehicle.battery.nominal_v : 1.0;
  for (const simulator::SixAxisRow& row : log) {
    rows.times_s.push_back(row.t_s);
    rows.velocities.insert(rows.velocities.end(), row.velocity.begin(), row.velocity.end());
    const std::array angles{row.attitude_rad(0), row.attitude_rad(1)};
    const std::array<double, 3> down =
        down_of({.roll = 0, .pitch = 1, .quaternion = {}, .headings = {}}, angles, Frame::frd);
    rows.down.insert(rows.down.end(), down.begin(), down.end());
    for (std::size_t k = 0; k < vehicle.thrusters.size(); ++k) {
      rows.commands.push_back(
          command_share(vehicle, k, row.commands(static_cast<Eigen::Index>(k)), kNeutralPulseUs));
    }
    if (has_battery) {
      rows.volts.push_back(row.voltage_v);
    }
  }
  return rows;
}

std::vector<double> six_axis_truth(const simulator::VehicleParameters& vehicle) {
  const simulator::Plant plant = simulator::make_plant(vehicle, simulator::Configuration{});
  std::vector<double> truth;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    truth.push_back(plant.mass(axis, axis));
  }
  truth.push_back(plant.mass(0, 4));
  truth.push_back(plant.mass(1, 5));
  truth.insert(truth.end(), plant.linear_damping.begin(), plant.linear_damping.end());
  truth.insert(truth.end(), plant.quadratic_damping.begin(), plant.quadratic_damping.end());
  truth.push_back(plant.net_weight_n);
  truth.insert(truth.end(), plant.weight_moment_nm.begin(), plant.weight_moment_nm.end());
  for (const simulator::Thruster& thruster : vehicle.thrusters) {
    const double full = thruster.max_speed_rps * thruster.max_speed_rps;
    truth.push_back(thruster.forward * full);
    truth.push_back(thruster.reverse * full);
  }
  truth.insert(truth.end(), {vehicle.rotor_lag_s, vehicle.rotor_delay_s,
                             vehicle.thrusters.front().dead_band, vehicle.battery.exponent});
  return truth;
}

Identification identify_six_axes(const log::Dataset& data, const Split& split,
                                 const SixAxisColumns& columns,
                                 const simulator::VehicleParameters& vehicle, Frame frame,
                                 double neutral, const KnownThrust& known, std::optional<int> only,
                                 const SixAxisSettings& options) {
  const std::vector<std::size_t> training = training_rows(data, split, only);
  const SixAxisRows rows = six_axis_rows(data, training, columns, vehicle, frame, neutral);
  Identification found = identification_of(data, split, training.size(), columns.targets,
                                           rows.commands, columns.thrusters.size());
  found.six = of_log(data, [&] { return fit_six_axes(rows, options); });
  const std::vector<std::size_t> held_out =
      of_configuration(data, split.held_out, data.configurations[training.front()]);
  judge_six_axes(data, held_out, columns,
                 six_axis_rows(data, held_out, columns, vehicle, frame, neutral), found);
  // Targets are of the log's frame.
  for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
    if (sign_in_frd(frame, axis) < 0.0) {
      for (std::vector<double>* values :
           {&found.held_out.structure[axis], &found.held_out.free[axis]}) {
        std::ranges::transform(*values, values->begin(), std::negate());
      }
    }
  }
  found.held_out.score();
  give_scale(known, found);
  return found;
}

}  // namespace kelpie::study
