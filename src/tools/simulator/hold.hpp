// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>

#include "simulator/integrator.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// Force and moments that keep a vehicle level and at its initial depth, zero: PID on depth, PDs on
/// roll and pitch.
class LevelHold {
 public:
  /// `greatest_force_n` bounds the integral.
  LevelHold(const HoldGains& gains, double greatest_force_n)
      : gains_(gains), greatest_force_n_(greatest_force_n) {}

  struct Demand {
    double down_n = 0.0;
    double roll_nm = 0.0;
    double pitch_nm = 0.0;
  };
  Demand update(const State& state, double period_s);  ///< For the next `period_s`.

 private:
  HoldGains gains_;
  double greatest_force_n_;
  double integral_n_ = 0.0;
};

/// The hold of a vehicle that is driven in the plane, through its two vertical thrusters; roll is
/// passive. The hold uses the parameters as built, not those of the configuration.
class DepthPitchHold {
 public:
  /// Requires a vehicle that passes validate() and drives_in_plane().
  explicit DepthPitchHold(const VehicleParameters& vehicle);

  /// Speeds of the front and the rear vertical thruster for the next `period_s`, rev/s.
  Eigen::Vector2d update(const State& state, double period_s);

 private:
  Thruster front_, rear_;
  Eigen::Matrix2d thrusts_from_demand_;  ///< heave force, pitch moment -> two thrusts
  LevelHold level_;
};

/// Allocation of the vertical thrusters: rows heave and pitch, columns front and rear.
Eigen::Matrix2d vertical_allocation(const VehicleParameters& vehicle);

}  // namespace kelpie::simulator
