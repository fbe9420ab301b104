// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>

#include "vehicle/integrator.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// Keeps the vehicle level and at its initial depth, zero: PID on depth and PD on pitch, through
/// the vertical thrusters. The hold uses the parameters as built, not those of the configuration.
class DepthPitchHold {
 public:
  /// Requires a vehicle that passes validate().
  explicit DepthPitchHold(const VehicleParameters& vehicle);

  /// Speeds of the front and the rear vertical thruster for the next `period_s`, rev/s.
  Eigen::Vector2d update(const State& state, double period_s);

 private:
  HoldGains gains_;
  Thruster front_, rear_;
  Eigen::Matrix2d thrusts_from_demand_;  ///< heave force, pitch moment -> two thrusts
  double greatest_force_n_;              ///< of both thrusters; bound of the integral
  double integral_n_ = 0.0;
};

/// Allocation of the vertical thrusters: rows heave and pitch, columns front and rear.
Eigen::Matrix2d vertical_allocation(const VehicleParameters& vehicle);

}  // namespace kelpie::vehicle
