// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>

#include "vehicle/dynamics.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// Where the vehicle is and how it moves.
struct State {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();          ///< NED
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< body to NED, unit
  Vector6 velocity = Vector6::Zero();                            ///< FRD, over ground
  RotorSpeeds rotors_rps = RotorSpeeds::Zero();

  bool is_finite() const;
};

/// What the rotors are told during a step, and how fast they follow.
struct RotorDrive {
  RotorSpeeds commands_rps = RotorSpeeds::Zero();
  double lag_s = 0.0;  ///< 0: the rotors turn at the commands' speed from the start of the step
};

/// One classical Runge-Kutta step of fourth order with the commands held.
/// Ensures: a unit quaternion. Allocates nothing.
State rk4_step(const Dynamics& dynamics, const State& state, const RotorDrive& drive,
               double step_s);

}  // namespace kelpie::vehicle
