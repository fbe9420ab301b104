// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>

#include "simulator/dynamics.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// Position, attitude and velocity of the vehicle, and speeds of its rotors.
struct State {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();          ///< NED
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< body to NED, unit
  Vector6 velocity = Vector6::Zero();                            ///< FRD, over ground
  RotorSpeeds rotors_rps;                                        ///< none: all stopped

  bool is_finite() const;
};

/// Commands of the rotors during a step, and their response.
struct RotorDrive {
  RotorSpeeds commands_rps;  ///< speeds at which the rotors settle
  double lag_s = 0.0;        ///< time constant; 0: the rotors follow at once
  double rate = 0.0;         ///< greatest change of speed per s; 0: any
};

/// One classical Runge-Kutta step of fourth order with the commands held. Requires as many commands
/// as speeds, or a state without speeds.
/// Ensures: a unit quaternion. Doesn't allocate.
State rk4_step(const Dynamics& dynamics, const State& state, const RotorDrive& drive,
               double step_s);

}  // namespace kelpie::simulator
