// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>

#include "vehicle/dynamics.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// Position, attitude and velocity of the vehicle, and speeds of its rotors.
struct State {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();          ///< NED
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< body to NED, unit
  Vector6 velocity = Vector6::Zero();                            ///< FRD, over ground
  RotorSpeeds rotors_rps = RotorSpeeds::Zero();

  bool is_finite() const;
};

/// Commands of the rotors during a step, and the time constant of their response.
struct RotorDrive {
  RotorSpeeds commands_rps = RotorSpeeds::Zero();
  double lag_s = 0.0;  ///< 0: the rotors follow at once
};

/// One classical Runge-Kutta step of fourth order with the commands held.
/// Ensures: a unit quaternion. Doesn't allocate.
State rk4_step(const Dynamics& dynamics, const State& state, const RotorDrive& drive,
               double step_s);

}  // namespace kelpie::vehicle
