// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "kelpie/model/dynamics_model.hpp"
#include "lab/controllers.hpp"

namespace kelpie::lab {

/// Accelerations from the last measurements: the slope of the least-squares line through an odd
/// number of them, at the time of the one in the middle, which is when they are of.
class SlopeWindow {
 public:
  /// Takes a measurement; returns what was sensed in the middle and the accelerations there, once
  /// there are enough.
  std::optional<std::pair<Sensed, Eigen::Vector3d>> add(const Sensed& sensed);

 private:
  static constexpr std::size_t kCount = 5;

  std::array<Sensed, kCount> ring_{};
  std::size_t seen_ = 0;
};

/// The model that (c) begins with and learns on: u, v, r and three rotor speeds to three
/// accelerations.
DynamicsModel untaught_model();

/// (c) The PID's accelerations and the reference's, as the learned model says how to get them:
///
///     f(ν_reference, n) + d = a_reference + a_PID,
///
/// solved for n by a few damped Gauss-Newton steps on the model's Jacobian, from the commands that
/// the nominal model would give; forces that this adds to the nominal model's are averaged over
/// half a second and more, and stay within a twentieth of the thrusters' most of what a disturbance
/// observer sees missing. d is what the model misses at present. Where the model says that
/// it doesn't know (novelty, interval), or the solution isn't one, the observer takes its place,
/// with something between on the way.
std::unique_ptr<Controller> make_learned(const NominalModel& nominal, DynamicsModel model);

}  // namespace kelpie::lab
