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

/// Accelerations: the slope of the least-squares line through the last measurements, an odd number,
/// at the time of the middle measurement.
class SlopeWindow {
 public:
  /// Takes a measurement. Returns the middle measurement and the accelerations of a full window.
  std::optional<std::pair<Sensed, Eigen::Vector3d>> add(const Sensed& sensed);

 private:
  static constexpr std::size_t kCount = 5;

  std::array<Sensed, kCount> ring_{};
  std::size_t seen_ = 0;
};

/// The untaught model of (c): u, v, r and three rotor speeds to three accelerations.
DynamicsModel untaught_model();

/// (c) The accelerations of PID and reference by the learned model:
///
///     f(ν_reference, n) + d = a_reference + a_PID,
///
/// solved for n by a few damped Gauss-Newton steps on the model's Jacobian from the nominal model's
/// commands. d is the model's present disturbance. The forces added to the nominal model's are
/// averaged over half a second and more, and stay within a twentieth of the greatest thrust around
/// the force seen by a disturbance observer. The observer gradually replaces a model of high
/// novelty or with wide intervals, and an invalid solution.
std::unique_ptr<Controller> make_learned(const NominalModel& nominal, DynamicsModel model);

}  // namespace kelpie::lab
