// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/alignment/alignment.hpp"
#include "kelpie/model/rollout.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::fmu {

/// Role of a variable of a Vehicle.
enum class Role : std::uint8_t {
  input,         ///< a command, or another input that the model does not integrate
  state,         ///< a velocity, an angle, the pose: settable before the start
  acceleration,  ///< a target of the model
};

/// A variable of a Vehicle, in the unit of the log that the model learned.
struct Variable {
  std::string name;
  Role role = Role::input;
  double start = 0.0;  ///< value before any other is set
};

/// A learned vehicle in simulation: velocities, attitude and pose from commands, by the equations
/// of a Rollout (Runge-Kutta, fourth order) behind the model's actuators. A copy keeps the state of
/// a moment.
///
/// Variables, in this order: every input of the model (commands, velocities, attitude); where
/// surge, sway and yaw rate are integrated (in m/s and rad/s), position_x and position_y [m] in a
/// frame fixed in the world, and heading [rad], counted from the x axis in the direction of yaw;
/// every target of the model.
class Vehicle {
 public:
  /// The longest step of the integrator [s].
  static constexpr double kStepS = 0.05;

  /// Throws InputError on a model that cannot be rolled out (open_loop()), and on a target or an
  /// input named as a part of the pose. Allocates.
  explicit Vehicle(TrainedModel model);

  std::span<const Variable> variables() const { return variables_; }
  double value(std::size_t variable) const { return values_[variable]; }
  /// Requires the role input, or before start() the role state.
  void set(std::size_t variable, double value) { values_[variable] = value; }

  /// Begins at `t` [s], with actuators at rest in the present commands. Accelerations are those of
  /// TrainedModel::predict() at the present inputs.
  void start(double t);

  /// Advances by dt_s >= 0, with the present inputs held. Throws InputError on a dt_s that is not
  /// finite, negative, or more than Rollout::kMostSteps steps; the state is unchanged then. Cost
  /// O(dt_s / kStepS). Allocates nothing.
  void advance(double dt_s);

  double time_s() const { return t_; }
  /// Whether every variable is finite.
  bool is_finite() const;

 private:
  void add_pose();
  void take_effects(double t);
  void move_pose(double dt_s);
  void take_states();
  void predict();

  std::shared_ptr<const TrainedModel> model_;  ///< shared by all copies
  Rollout rollout_;
  std::vector<Variable> variables_;
  std::vector<double> values_;  ///< of the variables
  std::size_t target_count_ = 0;
  struct Driven {
    std::size_t input;
    ActuatorState actuator;
    double taken_s = 0.0;  ///< when the actuator took its last command
    double effect = 0.0;
  };
  std::vector<Driven> driven_;  ///< commands with an actuator that takes time
  struct Pose {
    std::size_t surge, sway, yaw_rate, place;
  };
  std::optional<Pose> pose_;
  std::vector<double> x_;  ///< inputs of the model behind the actuators
  double t_ = 0.0;
};

}  // namespace kelpie::fmu
