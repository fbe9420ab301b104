// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>

#include "vehicle/integrator.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// Keeps the vehicle at depth zero (the depth it started at) and level: PID on depth, PD on pitch,
/// through the vertical thrusters. It knows the vehicle as built, not what has become of it.
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
  double greatest_force_n_;              ///< of both thrusters together, bounds the integral
  double integral_n_ = 0.0;
};

/// The allocation the hold works with: rows heave and pitch, columns front and rear.
Eigen::Matrix2d vertical_allocation(const VehicleParameters& vehicle);

}  // namespace kelpie::vehicle
