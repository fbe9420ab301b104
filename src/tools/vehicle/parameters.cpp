// SPDX-License-Identifier: Apache-2.0
#include "vehicle/parameters.hpp"

#include <algorithm>
#include <cmath>

#include "kelpie/core/error.hpp"
#include "vehicle/dynamics.hpp"
#include "vehicle/hold.hpp"

namespace kelpie::vehicle {
namespace {

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
}

void validate_hold(const HoldGains& hold) {
  require(not_negative(hold.depth_p), "hold.depth_p", "must not be negative");
  require(not_negative(hold.depth_i), "hold.depth_i", "must not be negative");
  require(not_negative(hold.depth_d), "hold.depth_d", "must not be negative");
  require(not_negative(hold.pitch_p), "hold.pitch_p", "must not be negative");
  require(not_negative(hold.pitch_d), "hold.pitch_d", "must not be negative");
}

}  // namespace

void VehicleParameters::validate() const {
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
  require(not_negative(rotor_lag_s), "rotors.lag_s", "must not be negative");
  for (std::size_t i = 0; i < kThrusterCount; ++i) {
    validate_thruster(thrusters[i], "thrusters." + thruster_names()[i]);
  }
  require(std::abs(vertical_allocation(*this).determinant()) > 1e-6, "thrusters.vertical_rear",
          "the two vertical thrusters must be able to hold heave and pitch independently");
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

const std::array<std::string, kThrusterCount>& thruster_names() {
  static const std::array<std::string, kThrusterCount> names = {"surge_left", "surge_right", "sway",
                                                                "vertical_front", "vertical_rear"};
  return names;
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

}  // namespace kelpie::vehicle
