// SPDX-License-Identifier: Apache-2.0
#include "simulator/parameters.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "motion/signal_names.hpp"
#include "simulator/dynamics.hpp"
#include "simulator/hold.hpp"
#include "simulator/simulator.hpp"
#include "simulator/tuning.hpp"

namespace kelpie::simulator {
namespace {

constexpr std::array kCommandUnits{"speed", "share", "pwm"};  // in the order of CommandUnit

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}
bool not_negative(double value) {
  return std::isfinite(value) && value >= 0.0;
}
bool not_negative(const Vector6& value) {
  return value.allFinite() && value.minCoeff() >= 0.0;
}

void validate_thruster(const Thruster& thruster, const std::string& field) {
  require(positive(thruster.forward), field + ".forward", "must be above zero, in N/(rev/s)²");
  require(positive(thruster.reverse), field + ".reverse", "must be above zero, in N/(rev/s)²");
  require(positive(thruster.max_speed_rps), field + ".max_speed_rps",
          "must be above zero, in rev/s");
  require(thruster.position_m.allFinite(), field + ".position_m", "must be finite");
  require(std::abs(thruster.direction.norm() - 1.0) < 1e-6, field + ".direction",
          "must be of length 1");
  require(thruster.dead_band >= 0.0 && thruster.dead_band < 1.0, field + ".dead_band",
          "must be at least 0 and below 1, a share of the greatest command");
}

void validate_rotors(const VehicleParameters& vehicle) {
  require(not_negative(vehicle.rotor_lag_s), "rotors.lag_s", "must not be negative");
  require(not_negative(vehicle.rotor_rate), "rotors.rate", "must not be negative; 0: any rate");
  require(vehicle.rotor_delay_s == 0.0 || (ticks_in(vehicle.rotor_delay_s) > 0 &&
                                           vehicle.rotor_delay_s <= kTuning.longest_delay_s),
          "rotors.delay_s",
          "must be a whole number of steps of " + number_text(kTickS) + " s, at most " +
              number_text(kTuning.longest_delay_s) + " s");
}

void validate_battery(const BatteryParameters& battery) {
  if (battery.nominal_v == 0.0) {
    return;
  }
  require(positive(battery.nominal_v), "battery.nominal_v", "must be above zero");
  require(positive(battery.full_v), "battery.full_v", "must be above zero");
  require(positive(battery.empty_v) && battery.empty_v <= battery.full_v, "battery.empty_v",
          "must be above zero and at most full_v");
  require(not_negative(battery.resistance_ohm), "battery.resistance_ohm", "must not be negative");
  require(positive(battery.capacity_ah), "battery.capacity_ah", "must be above zero");
  require(not_negative(battery.thruster_w), "battery.thruster_w", "must not be negative");
  require(not_negative(battery.idle_w), "battery.idle_w", "must not be negative");
  require(battery.exponent >= 0.0 && battery.exponent <= 3.0, "battery.exponent",
          "must be between 0 and 3");
}

void validate_hold(const HoldGains& hold) {
  require(not_negative(hold.depth_p), "hold.depth_p", "must not be negative");
  require(not_negative(hold.depth_i), "hold.depth_i", "must not be negative");
  require(not_negative(hold.depth_d), "hold.depth_d", "must not be negative");
  require(not_negative(hold.pitch_p), "hold.pitch_p", "must not be negative");
  require(not_negative(hold.pitch_d), "hold.pitch_d", "must not be negative");
  require(not_negative(hold.roll_p), "hold.roll_p", "must not be negative");
  require(not_negative(hold.roll_d), "hold.roll_d", "must not be negative");
}

}  // namespace

void VehicleParameters::validate() const {
  require(!thrusters.empty() && thrusters.size() <= kMostThrusters, "thrusters",
          "must be 1 to " + std::to_string(kMostThrusters));
  require(positive(mass_kg), "body.mass_kg", "must be above zero");
  require(is_symmetric(inertia_kg_m2), "body.inertia_kg_m2", "must be symmetric");
  require(is_positive_definite(inertia_kg_m2), "body.inertia_kg_m2", "must be positive definite");
  require(centre_of_gravity_m.allFinite(), "body.centre_of_gravity_m", "must be finite");
  require(centre_of_buoyancy_m.allFinite(), "body.centre_of_buoyancy_m", "must be finite");
  require(positive(mass_kg * kGravity + net_buoyancy_n), "body.net_buoyancy_n",
          "must not outweigh the whole weight: the buoyancy itself would be negative");
  require(is_symmetric(added_mass), "hydrodynamics.added_mass", "must be symmetric");
  require(is_positive_definite(make_plant(*this, Configuration{}).mass), "hydrodynamics.added_mass",
          "makes the mass matrix, rigid body and added mass together, not positive definite");
  require(not_negative(linear_damping), "hydrodynamics.linear_damping", "must not be negative");
  require(not_negative(quadratic_damping), "hydrodynamics.quadratic_damping",
          "must not be negative");
  validate_rotors(*this);
  for (const Thruster& thruster : thrusters) {
    validate_thruster(thruster, "thrusters." + thruster.name);
  }
  if (drives_in_plane(*this)) {
    require(std::abs(vertical_allocation(*this).determinant()) > 1e-6, "thrusters.vertical_rear",
            "the two vertical thrusters must be able to hold heave and pitch independently");
  }
  validate_battery(battery);
  validate_hold(hold);
}

void Configuration::validate(const std::string& field) const {
  require(effectiveness.allFinite() && effectiveness.minCoeff() >= 0.0, field + ".effectiveness",
          "must not be negative");
  require(not_negative(damping_factor), field + ".damping_factor", "must not be negative");
  require(std::isfinite(payload.mass_kg), field + ".payload.mass_kg", "must be finite");
  require(payload.position_m.allFinite(), field + ".payload.position_m", "must be finite");
  require(is_symmetric(payload.inertia_kg_m2), field + ".payload.inertia_kg_m2",
          "must be symmetric");
  require(is_symmetric(payload.added_mass), field + ".payload.added_mass", "must be symmetric");
  require(std::isfinite(payload.buoyancy_n), field + ".payload.buoyancy_n", "must be finite");
  require(pull_n.allFinite(), field + ".pull_n", "must be finite");
  require(pull_position_m.allFinite(), field + ".pull_position_m", "must be finite");
  require(sensors.scale.allFinite(), field + ".sensors.scale", "must be finite");
  require(sensors.bias.allFinite(), field + ".sensors.bias", "must be finite");
  require((sensors.frozen.array() == 0.0 || sensors.frozen.array() == 1.0).all(),
          field + ".sensors.frozen", "must be 0 or 1 for each of surge, sway, yaw");
}

const char* command_unit_name(CommandUnit unit) {
  return kCommandUnits[static_cast<std::size_t>(unit)];
}

CommandUnit command_unit_from(const std::string& name) {
  const std::vector<std::string> names(kCommandUnits.begin(), kCommandUnits.end());
  return static_cast<CommandUnit>(require_name({}, name, "kind of command", names));
}

const std::array<std::string, kPlanarThrusterCount>& planar_thruster_names() {
  static const std::array<std::string, kPlanarThrusterCount> names = {
      "surge_left", "surge_right", "sway", "vertical_front", "vertical_rear"};
  return names;
}

bool drives_in_plane(const VehicleParameters& vehicle) {
  return vehicle.command_unit == CommandUnit::speed &&
         std::ranges::equal(vehicle.thrusters, planar_thruster_names(), {}, &Thruster::name);
}

void require_plane(const VehicleParameters& vehicle) {
  if (!drives_in_plane(vehicle)) {
    std::vector<std::string> names;
    std::ranges::transform(vehicle.thrusters, std::back_inserter(names), &Thruster::name);
    const auto& wanted = planar_thruster_names();
    throw InputError("a drive in the plane needs the thrusters " + join_text(wanted, ", ") +
                     ", commanded by speed; this vehicle has " + join_text(names, ", "));
  }
}

double command_in_unit(CommandUnit unit, double command) {
  return unit == CommandUnit::pwm ? kNeutralPulseUs + kTuning.pulse_per_share_us * command
                                  : command;
}

double speed_for_command(const Thruster& thruster, double command) {
  if (thruster.dead_band == 0.0) {
    return command;  // exact
  }
  const double band = thruster.dead_band * thruster.max_speed_rps;
  const double beyond = std::max(0.0, std::abs(command) - band) / (1.0 - thruster.dead_band);
  return std::copysign(beyond, command);
}

double command_for_speed(const Thruster& thruster, double speed_rps) {
  if (speed_rps == 0.0) {
    return 0.0;
  }
  const double band = thruster.dead_band * thruster.max_speed_rps;
  return std::copysign(band + std::abs(speed_rps) * (1.0 - thruster.dead_band), speed_rps);
}

double thrust(const Thruster& thruster, double speed_rps) {
  const double coefficient = speed_rps < 0.0 ? thruster.reverse : thruster.forward;
  return coefficient * speed_rps * std::abs(speed_rps);
}

double speed_for_thrust(const Thruster& thruster, double force_n) {
  const double coefficient = force_n < 0.0 ? thruster.reverse : thruster.forward;
  const double speed = std::copysign(std::sqrt(std::abs(force_n) / coefficient), force_n);
  return std::clamp(speed, -thruster.max_speed_rps, thruster.max_speed_rps);
}

Vector6 thrust_axis(const Thruster& thruster) {
  return (Vector6() << thruster.direction, thruster.position_m.cross(thruster.direction))
      .finished();
}

ThrustAxes thrust_axes(const std::vector<Thruster>& thrusters) {
  ThrustAxes axes(6, static_cast<Eigen::Index>(thrusters.size()));
  for (std::size_t i = 0; i < thrusters.size(); ++i) {
    axes.col(static_cast<Eigen::Index>(i)) = thrust_axis(thrusters[i]);
  }
  return axes;
}

}  // namespace kelpie::simulator
