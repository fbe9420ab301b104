// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// Treatment of the added mass M_A in an engine.
enum class AddedMassForm : std::uint8_t {
  joined,             ///< in the mass matrix: (M_RB + M_A) ν̇ = …
  mean_joined,        ///< the mean of surge, sway and heave in the mass; rotations in the inertia
  last_acceleration,  ///< a force −M_A (ν_k − ν_k−1)/h
  filtered_acceleration  ///< a force −M_A f_k, f_k = (1 − α) f_k−1 + α (ν_k − ν_k−1)/h
};

/// A step of length h.
enum class StepForm : std::uint8_t {
  runge_kutta,  ///< fourth order, of the body's velocity
  body_euler,   ///< ν in the body's axes first, then the attitude from the new ν
  world_euler   ///< velocity of the centre of gravity in world axes first, then the attitude
};

/// The equations of a simulator, as documentation and sources of that simulator have them
/// (docs/howto/identify.md, "Certificate").
struct Engine {
  std::string_view name;   ///< of the option --for
  std::string_view title;  ///< for people
  AddedMassForm added_mass = AddedMassForm::joined;
  double newest = 1.0;         ///< α of filtered_acceleration
  bool added_coriolis = true;  ///< C_A(ν) ν where M_A is a force; joined: always
  StepForm step = StepForm::runge_kutta;
  double step_s = 0.01;  ///< the engine's usual step
};

/// All engines, the project's own simulator first.
std::span<const Engine> engines();

/// Coefficients of Fossen's equation with body and water apart, and the axes that move: of a log
/// in the plane surge, sway and yaw, the others being held at rest.
struct EngineBody {
  double mass_kg = 0.0;
  Eigen::Vector3d centre_of_gravity_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  ///< about the centre of gravity
  Matrix6 added_mass = Matrix6::Zero();
  Vector6 linear_damping = Vector6::Zero();
  Vector6 quadratic_damping = Vector6::Zero();
  double net_weight_n = 0.0;                                   ///< weight − buoyancy
  Eigen::Vector3d weight_moment_nm = Eigen::Vector3d::Zero();  ///< W r_g − B r_b
  std::array<bool, 6> free{true, true, true, true, true, true};
  bool coriolis = true;  ///< false: neither body nor water have C(ν) ν
};

/// The coefficients of a vehicle; thrusters take no part.
EngineBody engine_body(const VehicleParameters& vehicle, const std::array<bool, 6>& free);

/// What an engine keeps from step to step.
struct EngineState {
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< body to NED
  Vector6 velocity = Vector6::Zero();
  Vector6 last_velocity = Vector6::Zero();  ///< of the step before
  Vector6 filtered_acceleration = Vector6::Zero();

  /// At rest relative to its own past: no acceleration so far.
  static EngineState at(const Eigen::Quaterniond& attitude, const Vector6& velocity);
  bool is_finite() const;
};

/// An engine with a body, at a step. Doesn't allocate after construction.
class EngineRun {
 public:
  /// Requires step_s > 0 and a positive definite mass matrix on the free axes.
  EngineRun(const Engine& engine, const EngineBody& body, double step_s);

  /// One step under a force of thrusters that is constant in the body, FRD about the origin.
  EngineState next(const EngineState& state, const Vector6& force) const;

  double step_s() const { return step_s_; }
  const EngineBody& body() const { return body_; }

 private:
  Vector6 forces(const EngineState& state, const Vector6& force) const;
  Vector6 rate(const EngineState& state, const Vector6& force) const;
  EngineState world_step(const EngineState& state, const Vector6& force) const;
  EngineState runge_kutta_step(const EngineState& state, const Vector6& force) const;
  Vector6 held(Vector6 velocity) const;

  Engine engine_;
  EngineBody body_;
  double step_s_;
  double mass_kg_;           // with the mean of the added mass where the engine has it so
  Eigen::Matrix3d inertia_;  // about the centre of gravity
  Matrix6 mass_;             // that is accelerated
  Matrix6 inverse_mass_;     // on the free axes; zero elsewhere
};

}  // namespace kelpie::simulator
