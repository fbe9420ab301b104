// SPDX-License-Identifier: Apache-2.0
#include "format/identified_vehicle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "core/text.hpp"
#include "format/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "simulator/decomposition.hpp"
#include "simulator/dynamics.hpp"
#include "simulator/simulator.hpp"
#include "study/six_axes.hpp"
#include "study/tuning.hpp"

namespace kelpie::format {
namespace {

using simulator::VehicleParameters;

constexpr std::array<Eigen::Index, kPlanarAxes> kOfSix{0, 1, 5};

double revolutions(const std::string& unit) {
  if (unit.empty() || unit == "rev/s" || unit == "rev s^-1" || unit == "rps" || unit == "Hz" ||
      unit == "s^-1") {
    return 1.0;
  }
  if (unit == "rad/s" || unit == "rad s^-1") {
    return 0.5 / std::numbers::pi;
  }
  if (unit == "rpm" || unit == "rev min^-1" || unit == "min^-1") {
    return 1.0 / 60.0;
  }
  throw InputError("--units", "'" + unit +
                                  "' is no thruster's speed that simulators know; they "
                                  "take rev/s, rad/s or rpm");
}

// What a log in the plane doesn't show, where no vehicle file tells it.
VehicleParameters assumed(const PlanarVehicle& plane, double mass_kg) {
  VehicleParameters body;
  body.mass_kg = mass_kg;
  const double yaw = plane.yaw_inertia * mass_kg / plane.surge_inertia;
  const double sway_added = plane.sway_inertia - mass_kg;
  const double yaw_added = plane.yaw_inertia - yaw;
  body.inertia_kg_m2 = Eigen::Vector3d(kTuning.roll_over_yaw * yaw, yaw, yaw).asDiagonal();
  body.centre_of_gravity_m = {0.0, 0.0, kTuning.low_centre_m};
  body.added_mass(2, 2) = sway_added;
  body.added_mass(3, 3) = kTuning.roll_over_yaw * yaw_added;
  body.added_mass(4, 4) = yaw_added;
  body.linear_damping << 0.0, 0.0, plane.linear_drag[1], plane.linear_drag[2], plane.linear_drag[2],
      0.0;
  body.quadratic_damping << 0.0, 0.0, plane.quadratic_drag[1], plane.quadratic_drag[2],
      plane.quadratic_drag[2], 0.0;
  const double heave = plane.sway_inertia;
  body.hold = {.depth_p = heave * kTuning.depth_per_s * kTuning.depth_per_s,
               .depth_i = kTuning.depth_integral * heave,
               .depth_d = kTuning.depth_damping * heave * kTuning.depth_per_s,
               .pitch_p = plane.yaw_inertia * kTuning.pitch_per_s,
               .pitch_d = plane.yaw_inertia * kTuning.pitch_per_s};
  return body;
}

void set_plane(const PlanarVehicle& plane, VehicleParameters& body) {
  const double yaw =
      body.inertia_kg_m2(2, 2) + body.mass_kg * body.centre_of_gravity_m.head<2>().squaredNorm();
  const double coupling = body.mass_kg * body.centre_of_gravity_m(0);
  body.added_mass(0, 0) = plane.surge_inertia - body.mass_kg;
  body.added_mass(1, 1) = plane.sway_inertia - body.mass_kg;
  body.added_mass(5, 5) = plane.yaw_inertia - yaw;
  body.added_mass(1, 5) = body.added_mass(5, 1) = plane.sway_yaw_inertia - coupling;
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    body.linear_damping(kOfSix[axis]) = plane.linear_drag[axis];
    body.quadratic_damping(kOfSix[axis]) = plane.quadratic_drag[axis];
  }
}

void turn_to_frd(PlanarVehicle& plane) {
  for (PlanarThruster& thruster : plane.thrusters) {
    thruster.angle_rad = -thruster.angle_rad;
    thruster.arm_m = -thruster.arm_m;
  }
  plane.constant_force[1] = -plane.constant_force[1];
  plane.constant_force[2] = -plane.constant_force[2];
}

// At the place on its line of action that is nearest to the origin.
IdentifiedThruster in_six(const PlanarThruster& thruster) {
  const double c = std::cos(thruster.angle_rad);
  const double s = std::sin(thruster.angle_rad);
  return {.name = thruster.name,
          .forward = thruster.forward,
          .reverse = thruster.reverse,
          .position_m = {thruster.arm_m * s, -thruster.arm_m * c, 0.0},
          .direction = {c, s, 0.0}};
}

simulator::Thruster file_thruster(const IdentifiedThruster& thruster) {
  return {.forward = thruster.forward,
          .reverse = thruster.reverse,
          .position_m = thruster.position_m,
          .direction = thruster.direction,
          .max_speed_rps = thruster.greatest,
          .name = thruster.name};
}

bool is_along(const IdentifiedThruster& thruster, double cosine_or_sine) {
  return std::abs(cosine_or_sine) > std::cos(kTuning.most_off_rad) && thruster.forward > 0.0 &&
         thruster.reverse > 0.0;
}

// The simulator has two thrusters along surge, one along sway and two vertical ones.
void fill_slots(IdentifiedVehicle& result, bool has_verticals) {
  std::vector<std::size_t> surge;
  std::vector<std::size_t> sway;
  for (std::size_t i = 0; i < result.thrusters.size(); ++i) {
    const IdentifiedThruster& thruster = result.thrusters[i];
    if (is_along(thruster, thruster.direction.x())) {
      surge.push_back(i);
    } else if (is_along(thruster, thruster.direction.y())) {
      sway.push_back(i);
    }
  }
  if (surge.size() != 2 || sway.size() != 1 || result.thrusters.size() != 3) {
    return;
  }
  result.body.thrusters.resize(simulator::kPlanarThrusterCount);
  const auto put = [&](std::size_t slot, std::size_t i) {
    result.body.thrusters[slot] = file_thruster(result.thrusters[i]);
    result.body.thrusters[slot].name = simulator::planar_thruster_names()[slot];
  };
  const auto side = [&](std::size_t i) {  // negative: left of the middle
    return result.thrusters[i].position_m(1);
  };
  std::ranges::sort(surge, {}, side);
  put(simulator::kSurgeLeft, surge[0]);
  put(simulator::kSurgeRight, surge[1]);
  put(simulator::kSway, sway[0]);
  if (!has_verticals) {
    for (const auto slot : {simulator::kVerticalFront, simulator::kVerticalRear}) {
      simulator::Thruster& vertical = result.body.thrusters[slot];
      vertical = result.body.thrusters[simulator::kSway];
      vertical.name = simulator::planar_thruster_names()[slot];
      vertical.direction = Eigen::Vector3d::UnitZ();
      vertical.position_m = {
          slot == simulator::kVerticalFront ? kTuning.vertical_arm_m : -kTuning.vertical_arm_m, 0.0,
          0.0};
    }
  }
  result.has_slots = true;
}

simulator::Vector6 velocity_of(const DriveColumns& columns, std::span<const double> inputs,
                               Frame frame) {
  simulator::Vector6 velocity = simulator::Vector6::Zero();
  for (std::size_t axis = 0; axis < columns.velocities.size(); ++axis) {
    if (columns.velocities[axis]) {
      velocity(static_cast<Eigen::Index>(axis)) =
          study::sign_in_frd(frame, axis) * inputs[*columns.velocities[axis]];
    }
  }
  return velocity;
}

bool has_minute(const study::RecordedDrive& drive) {
  constexpr double kMinuteS = 60.0;
  for (std::size_t i = 0; i < drive.starts.size(); ++i) {
    if (drive.times_s[drive.end_of(i) - 1] - drive.times_s[drive.starts[i]] >= kMinuteS) {
      return true;
    }
  }
  return false;
}

study::RecordedDrive drive_of(const IdentifiedVehicle& vehicle, const log::Dataset& data,
                              const std::vector<std::size_t>& rows, const DriveColumns& columns,
                              Frame frame) {
  study::RecordedDrive drive;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t row = rows[i];
    if (i == 0 || !log::follows(data, rows[i - 1], row)) {
      drive.starts.push_back(i);
    }
    const std::span<const double> inputs = data.input(row);
    drive.times_s.push_back(data.times_s[row]);
    drive.velocities.push_back(velocity_of(columns, inputs, frame));
    drive.attitudes.push_back(Eigen::Quaterniond::Identity());
    simulator::Vector6 force = vehicle.constant_force;
    for (std::size_t k = 0; k < columns.thrusters.size(); ++k) {
      force += vehicle.thrusters[k].force(columns.revolutions[k] * inputs[columns.thrusters[k]]);
    }
    drive.forces.push_back(force);
  }
  return drive;
}

// Held-out rows of the configuration where these have a stretch of a minute, else all its rows.
template <typename Drive>
study::RecordedDrive of_chosen_rows(const log::Dataset& data, const study::Split& split,
                                    std::optional<int> only, Drive drive_of_rows) {
  const int wanted = data.configurations[study::training_rows(data, split, only).front()];
  study::RecordedDrive drive = drive_of_rows(study::of_configuration(data, split.held_out, wanted));
  drive.rows_text = "held-out rows";
  if (!has_minute(drive)) {
    std::vector<std::size_t> all(data.rows());
    std::iota(all.begin(), all.end(), std::size_t{0});
    drive = drive_of_rows(study::of_configuration(data, std::move(all), wanted));
    drive.rows_text = "all rows, those of the identification among them";
  }
  return drive;
}

// The value of a parameter that the log tells; else nothing.
std::optional<double> told_value(const SixAxisFit& fit, std::size_t place) {
  const FittedParameter& parameter = fit.parameters[place];
  return parameter.state == ParameterState::not_told ? std::nullopt
                                                     : std::optional(parameter.value);
}

void set_inertias(const SixAxisFit& fit, VehicleParameters& body) {
  const simulator::Matrix6 rigid =
      simulator::rigid_body_mass(body.mass_kg, body.centre_of_gravity_m, body.inertia_kg_m2);
  for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
    const auto place = static_cast<Eigen::Index>(axis);
    const double added = fit.parameters[SixAxisPlace::inertia + axis].value - rigid(place, place);
    if (added < 0.0) {
      throw InputError(axis < 3 ? "--mass" : "--vehicle",
                       fmt::format("the rigid body's {} of {:.4g} is above the identified {} of "
                                   "{:.4g}, which has the added mass as well",
                                   axis < 3 ? "mass" : "moment of inertia", rigid(place, place),
                                   fit.parameters[SixAxisPlace::inertia + axis].name,
                                   fit.parameters[SixAxisPlace::inertia + axis].value));
    }
    body.added_mass(place, place) = added;
  }
  const auto couple = [&](std::size_t parameter, Eigen::Index a, Eigen::Index b, double sign) {
    if (const std::optional<double> value = told_value(fit, parameter)) {
      body.added_mass(a, b) = body.added_mass(b, a) = sign * *value - rigid(a, b);
    }
  };
  couple(SixAxisPlace::low_centre, 0, 4, 1.0);
  couple(SixAxisPlace::low_centre, 1, 3, -1.0);
  couple(SixAxisPlace::forward_centre, 1, 5, 1.0);
  couple(SixAxisPlace::forward_centre, 2, 4, -1.0);
}

void set_forces(const SixAxisFit& fit, VehicleParameters& body) {
  for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
    const auto place = static_cast<Eigen::Index>(axis);
    body.linear_damping(place) =
        told_value(fit, SixAxisPlace::linear_drag + axis).value_or(body.linear_damping(place));
    body.quadratic_damping(place) = told_value(fit, SixAxisPlace::quadratic_drag + axis)
                                        .value_or(body.quadratic_damping(place));
  }
  body.net_buoyancy_n = -told_value(fit, SixAxisPlace::net_weight).value_or(-body.net_buoyancy_n);
  const double weight = body.mass_kg * simulator::kGravity;
  const double buoyancy = weight + body.net_buoyancy_n;
  for (std::size_t i = 0; i < 3; ++i) {
    if (const std::optional<double> moment = told_value(fit, SixAxisPlace::moment + i)) {
      const auto place = static_cast<Eigen::Index>(i);
      body.centre_of_buoyancy_m(place) =
          (weight * body.centre_of_gravity_m(place) - *moment) / buoyancy;
    }
  }
}

}  // namespace

double IdentifiedThruster::thrust(double speed) const {
  return (speed > 0.0 ? forward : reverse) * speed * std::abs(speed);
}

simulator::Vector6 IdentifiedThruster::force(double speed) const {
  return thrust(speed) *
         (simulator::Vector6() << direction, position_m.cross(direction)).finished();
}

IdentifiedVehicle identified_on_six_axes(const study::Identification& found,
                                         const VehicleParameters& base,
                                         const std::string& base_file) {
  const SixAxisFit& fit = *found.six;
  IdentifiedVehicle result{.body = base};
  result.identified.fill(true);
  result.speeds = base.command_unit == simulator::CommandUnit::speed;
  result.speed_unit = result.speeds ? "in rev/s" : "as shares, -1 to 1, of the full command";
  result.has_slots = true;
  result.body.mass_kg = found.mass_kg.value_or(base.mass_kg);
  set_inertias(fit, result.body);
  set_forces(fit, result.body);
  result.body.rotor_lag_s = fit.curve.lag_s;
  result.body.rotor_delay_s = std::round(fit.curve.delay_s * simulator::kTicksPerSecond) /
                              static_cast<double>(simulator::kTicksPerSecond);
  result.body.battery.exponent = fit.curve.exponent;
  for (std::size_t i = 0; i < base.thrusters.size(); ++i) {
    simulator::Thruster& slot = result.body.thrusters[i];
    const double full = result.speeds ? slot.max_speed_rps * slot.max_speed_rps : 1.0;
    const std::size_t place = SixAxisPlace::thruster(i);
    slot.forward = fit.parameters[place].value / full;
    const std::optional<double> reverse = told_value(fit, place + 1);
    slot.reverse = reverse ? *reverse / full : slot.forward;
    slot.dead_band = fit.curve.dead_band;
    const double most = result.speeds ? slot.max_speed_rps : 1.0;
    result.thrusters.push_back({.name = slot.name,
                                .forward = slot.forward,
                                .reverse = slot.reverse,
                                .position_m = slot.position_m,
                                .direction = slot.direction,
                                .greatest = std::min(1.0, found.greatest_speeds[i]) * most,
                                .reverse_told = reverse.has_value(),
                                .lag_s = fit.curve.lag_s});
  }
  std::vector<std::string> missing;
  for (const FittedParameter& parameter : fit.parameters) {
    if (parameter.state == ParameterState::not_told) {
      missing.push_back(parameter.name);
    }
  }
  result.rest =
      "mass and moments of inertia of the rigid body, centre of gravity, places of "
      "thrusters, battery and hold as in " +
      base_file;
  if (!missing.empty()) {
    result.rest += "; not told by the log and as there: " + join_text(missing, ", ");
  }
  return result;
}

DriveColumns drive_columns(const study::PlanarColumns& columns,
                           const study::Identification& found) {
  DriveColumns drive{.thrusters = columns.thrusters};
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    drive.velocities[static_cast<std::size_t>(kOfSix[axis])] = columns.velocities[axis];
  }
  for (const std::string& unit : found.speed_units) {
    drive.revolutions.push_back(revolutions(unit));
  }
  return drive;
}

study::RecordedDrive recorded_drive(const IdentifiedVehicle& vehicle, const log::Dataset& data,
                                    const study::Split& split, const DriveColumns& columns,
                                    Frame frame, std::optional<int> only) {
  return of_chosen_rows(data, split, only, [&](const std::vector<std::size_t>& rows) {
    return drive_of(vehicle, data, rows, columns, frame);
  });
}

study::RecordedDrive recorded_drive(const IdentifiedVehicle& vehicle,
                                    const study::Identification& found, const log::Dataset& data,
                                    const study::Split& split, const study::SixAxisColumns& columns,
                                    const simulator::VehicleParameters& base, Frame frame,
                                    double neutral, std::optional<int> only) {
  return of_chosen_rows(data, split, only, [&](const std::vector<std::size_t>& picked) {
    const SixAxisRows rows = study::six_axis_rows(data, picked, columns, base, frame, neutral);
    const std::vector<double> speeds = thruster_speeds(rows, found.six->curve);
    const std::size_t count = rows.thrusters.size();
    study::RecordedDrive drive{.times_s = rows.times_s, .starts = rows.starts};
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      drive.velocities.emplace_back(
          Eigen::Map<const simulator::Vector6>(rows.velocities.data() + kSixAxes * row));
      const Eigen::Map<const Eigen::Vector3d> down(rows.down.data() + 3 * row);
      drive.attitudes.push_back(simulator::attitude_of(down));
      simulator::Vector6 force = simulator::Vector6::Zero();
      for (std::size_t k = 0; k < count; ++k) {
        // The fit's thrusts are those of shares of the full command.
        const double share = speeds[row * count + k];
        const double speed = vehicle.speeds ? share * base.thrusters[k].max_speed_rps : share;
        force += vehicle.thrusters[k].force(speed);
      }
      drive.forces.push_back(force);
    }
    return drive;
  });
}

IdentifiedVehicle identified_vehicle(const study::Identification& found, Frame frame,
                                     const std::optional<VehicleParameters>& base,
                                     const std::string& base_file) {
  PlanarVehicle plane = found.planar.vehicle();
  if (frame == Frame::flu) {
    turn_to_frd(plane);
  }
  IdentifiedVehicle result;
  result.speed_unit = "as the log's units say";
  result.identified = {true, true, false, false, false, true};
  for (std::size_t i = 0; i < plane.thrusters.size(); ++i) {
    IdentifiedThruster thruster = in_six(plane.thrusters[i]);
    const double turns = revolutions(found.speed_units[i]);
    if (found.speed_units[i].empty()) {
      result.speed_unit = "taken for rev/s: the log's units don't say";
    }
    const ParameterState reverse = found.planar.parameters[PlanarPlace::thruster(i) + 1].state;
    thruster.reverse_told = reverse != ParameterState::not_told;
    if (!thruster.reverse_told) {
      thruster.reverse = thruster.forward;
    }
    thruster.forward /= turns * turns;
    thruster.reverse /= turns * turns;
    thruster.greatest = found.greatest_speeds[i] * turns;
    const auto lag = std::ranges::find(found.lags, thruster.name, &LagInterval::command);
    thruster.lag_s = lag == found.lags.end() ? 0.0 : lag->lag_s;
    result.thrusters.push_back(thruster);
  }
  const double mass_kg = found.mass_kg.value_or(plane.surge_inertia /
                                                (1.0 + study::kTuning.identification.added_share));
  result.body = base.value_or(assumed(plane, mass_kg));
  const bool has_verticals = base && simulator::drives_in_plane(*base);
  result.body.mass_kg = mass_kg;
  result.rest = base
                    ? "heave, roll, pitch, buoyancy, rotors and hold as in " + base_file
                    : "heave, roll, pitch, buoyancy and hold assumed: heave as sway, pitch as yaw, "
                      "roll a third of it, the centre of gravity 5 cm low";
  if (!found.mass_kg) {
    result.rest += "; the rigid body's mass assumed, surge inertia / 1.2";
  }
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    result.constant_force(kOfSix[axis]) = plane.constant_force[axis];
  }
  set_plane(plane, result.body);
  fill_slots(result, has_verticals);
  return result;
}

}  // namespace kelpie::format
