// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "kelpie/model/dynamics_model.hpp"
#include "lab/controllers.hpp"

namespace kelpie::lab {

/// Gives a controller velocity and position while the velocity log and the position are silent
/// (Sensed::silent); heading, yaw rate and rotor speeds are always measured.
class Reckoner {
 public:
  virtual ~Reckoner() = default;
  /// The measurement, or what stands in for it. Called once per period.
  Sensed complete(const Sensed& sensed);

 protected:
  /// Surge and sway; measured where not silent.
  virtual Eigen::Vector2d velocity(const Sensed& sensed) = 0;

 private:
  Pose2 pose_ = Pose2::Zero();
};

/// The equation of motion of the nominal vehicle, from the last measured velocity on.
std::unique_ptr<Reckoner> make_nominal_reckoner(const NominalModel& nominal);

/// DeadReckoning with the steady part of a model that goes on learning; the model is taken anew
/// every 10 s of measured velocities. `model` has to outlive the reckoner.
std::unique_ptr<Reckoner> make_learned_reckoner(const DynamicsModel& model);

}  // namespace kelpie::lab
