// SPDX-License-Identifier: Apache-2.0
#include "simulator/integrator.hpp"

#include <cmath>

namespace kelpie::simulator {
namespace {

// position, quaternion (x, y, z, w as Eigen stores it), velocity, rotors
constexpr int kBodyStates = 13;
using StateVector =
    Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kBodyStates + kMostThrusters, 1>;

StateVector pack(const State& state) {
  StateVector x(kBodyStates + state.rotors_rps.size());
  x << state.position_m, state.attitude.coeffs(), state.velocity, state.rotors_rps;
  return x;
}

State unpack(const StateVector& x) {
  State state;
  state.position_m = x.segment<3>(0);
  state.attitude.coeffs() = x.segment<4>(3);
  state.velocity = x.segment<6>(7);
  state.rotors_rps = x.tail(x.size() - kBodyStates);
  return state;
}

StateVector rate(const Dynamics& dynamics, const RotorDrive& drive, const StateVector& x) {
  const State state = unpack(x);
  const Eigen::Vector3d turn = 0.5 * state.velocity.tail<3>();
  const Eigen::Quaterniond half_rate(0.0, turn.x(), turn.y(), turn.z());

  State derivative;
  derivative.position_m = state.attitude.toRotationMatrix() * state.velocity.head<3>();
  derivative.attitude = state.attitude * half_rate;  // q̇ = ½ q ⊗ (0, ω)
  derivative.velocity = dynamics.acceleration(state.attitude, state.velocity, state.rotors_rps);
  if (drive.lag_s > 0.0) {
    derivative.rotors_rps = (drive.commands_rps - state.rotors_rps) / drive.lag_s;
    if (drive.rate > 0.0) {
      derivative.rotors_rps =
          derivative.rotors_rps.cwiseMax(-drive.rate).cwiseMin(drive.rate).eval();
    }
  } else {
    derivative.rotors_rps = RotorSpeeds::Zero(state.rotors_rps.size());
  }
  return pack(derivative);
}

// Speeds of rotors without lag after a step.
RotorSpeeds followed(const RotorSpeeds& speeds, const RotorDrive& drive, double step_s) {
  if (drive.rate == 0.0) {
    return drive.commands_rps;
  }
  const double most = drive.rate * std::abs(step_s);
  return speeds + (drive.commands_rps - speeds).cwiseMax(-most).cwiseMin(most);
}

}  // namespace

bool State::is_finite() const {
  return position_m.allFinite() && attitude.coeffs().allFinite() && velocity.allFinite() &&
         rotors_rps.allFinite();
}

State rk4_step(const Dynamics& dynamics, const State& state, const RotorDrive& drive,
               double step_s) {
  State start = state;
  if (start.rotors_rps.size() == 0) {
    start.rotors_rps = RotorSpeeds::Zero(drive.commands_rps.size());
  }
  StateVector x = pack(start);
  if (drive.lag_s == 0.0) {
    x.tail(x.size() - kBodyStates) = followed(start.rotors_rps, drive, step_s);
  }
  const StateVector k1 = rate(dynamics, drive, x);
  const StateVector k2 = rate(dynamics, drive, x + step_s / 2.0 * k1);
  const StateVector k3 = rate(dynamics, drive, x + step_s / 2.0 * k2);
  const StateVector k4 = rate(dynamics, drive, x + step_s * k3);
  State next = unpack(x + step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
  next.attitude.normalize();
  return next;
}

}  // namespace kelpie::simulator
