// SPDX-License-Identifier: Apache-2.0
#include "simulator/engine.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "simulator/dynamics.hpp"

namespace kelpie::simulator {
namespace {

// Sources, read in November 2026; docs/howto/identify.md, "Certificate", has the addresses.
// Gazebo: gz-physics, AddedMassFeatures.cc (<fluid_added_mass> in DART's spatial inertia) and
// SimulationFeatures.cc (weight of the dry mass as a force); DART, World::step:
// integrateVelocities, then integratePositions. The plugin: gz-sim, Hydrodynamics.cc (stateDot),
// issue 1923. UUV Simulator: HydrodynamicModel::ComputeAcc (α = 0.3); ODE, dxStepBody: positions
// from the new world velocities of the centre of gravity. Stonefish: SolidEntity::getAugmentedMass;
// Bullet steps as ODE does. MSS: SIMremus100.m, rk4, h = 0.05. Python Vehicle Simulator:
// mainLoop.py, dynamics (forward Euler), then attitudeEuler with the new nu; main.py, 0.02 s.
constexpr std::array kEngines{
    Engine{"kelpie", "kelpie simulate: Fossen's equation, Runge-Kutta"},
    Engine{"gazebo", "Gazebo Harmonic, DART with <fluid_added_mass>", AddedMassForm::joined, 1.0,
           true, StepForm::body_euler, 0.001},
    Engine{"gazebo_plugin", "Gazebo, added mass by the Hydrodynamics plugin",
           AddedMassForm::last_acceleration, 1.0, false, StepForm::body_euler, 0.001},
    Engine{"uuv_simulator", "UUV Simulator, Plankton", AddedMassForm::filtered_acceleration, 0.3,
           true, StepForm::world_euler, 0.002},
    Engine{"stonefish", "Stonefish, drag as identified", AddedMassForm::mean_joined, 1.0, false,
           StepForm::world_euler, 0.002},
    Engine{"mss", "MSS", AddedMassForm::joined, 1.0, true, StepForm::runge_kutta, 0.05},
    Engine{"python_vehicle_simulator", "Python Vehicle Simulator", AddedMassForm::joined, 1.0, true,
           StepForm::body_euler, 0.02}};

Eigen::Quaterniond turned(const Eigen::Quaterniond& attitude, const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle == 0.0) {
    return attitude;
  }
  const Eigen::AngleAxisd turn(angle, rotation / angle);
  return (attitude * turn).normalized();
}

Matrix6 inverse_on(const std::array<bool, 6>& free, const Matrix6& mass) {
  std::vector<Eigen::Index> axes;
  for (std::size_t axis = 0; axis < free.size(); ++axis) {
    if (free[axis]) {
      axes.push_back(static_cast<Eigen::Index>(axis));
    }
  }
  Matrix6 inverse = Matrix6::Zero();
  const Eigen::MatrixXd part = mass(axes, axes);
  const Eigen::MatrixXd inverse_part = part.partialPivLu().inverse();
  inverse(axes, axes) = inverse_part;
  return inverse;
}

bool is_force(AddedMassForm form) {
  return form == AddedMassForm::last_acceleration || form == AddedMassForm::filtered_acceleration;
}

}  // namespace

std::span<const Engine> engines() {
  return kEngines;
}

EngineBody engine_body(const VehicleParameters& vehicle, const std::array<bool, 6>& free) {
  const double weight = vehicle.mass_kg * kGravity;
  return {.mass_kg = vehicle.mass_kg,
          .centre_of_gravity_m = vehicle.centre_of_gravity_m,
          .inertia_kg_m2 = vehicle.inertia_kg_m2,
          .added_mass = vehicle.added_mass,
          .linear_damping = vehicle.linear_damping,
          .quadratic_damping = vehicle.quadratic_damping,
          .net_weight_n = -vehicle.net_buoyancy_n,
          .weight_moment_nm = weight * vehicle.centre_of_gravity_m -
                              (weight + vehicle.net_buoyancy_n) * vehicle.centre_of_buoyancy_m,
          .free = free};
}

EngineState EngineState::at(const Eigen::Quaterniond& attitude, const Vector6& velocity) {
  return {.attitude = attitude, .velocity = velocity, .last_velocity = velocity};
}

bool EngineState::is_finite() const {
  return attitude.coeffs().allFinite() && velocity.allFinite() && filtered_acceleration.allFinite();
}

EngineRun::EngineRun(const Engine& engine, const EngineBody& body, double step_s)
    : engine_(engine),
      body_(body),
      step_s_(step_s),
      mass_kg_(body.mass_kg),
      inertia_(body.inertia_kg_m2) {
  if (engine.added_mass == AddedMassForm::mean_joined) {
    mass_kg_ += body.added_mass.diagonal().head<3>().mean();
    inertia_.diagonal() += body.added_mass.diagonal().tail<3>();
  }
  mass_ = rigid_body_mass(mass_kg_, body.centre_of_gravity_m, inertia_);
  if (engine.added_mass == AddedMassForm::joined) {
    mass_ += body.added_mass;
  }
  inverse_mass_ = inverse_on(body.free, mass_);
}

Vector6 EngineRun::held(Vector6 velocity) const {
  for (std::size_t axis = 0; axis < body_.free.size(); ++axis) {
    velocity(static_cast<Eigen::Index>(axis)) *= body_.free[axis] ? 1.0 : 0.0;
  }
  return velocity;
}

// All forces but inertia and Coriolis forces of the mass that is accelerated.
Vector6 EngineRun::forces(const EngineState& state, const Vector6& force) const {
  const Vector6& velocity = state.velocity;
  const Eigen::Vector3d down = state.attitude.toRotationMatrix().transpose().col(2);
  Vector6 sum =
      force - (body_.linear_damping + body_.quadratic_damping.cwiseProduct(velocity.cwiseAbs()))
                  .cwiseProduct(velocity);
  sum.head<3>() += body_.net_weight_n * down;
  sum.tail<3>() += body_.weight_moment_nm.cross(down);
  if (is_force(engine_.added_mass)) {
    sum -= body_.added_mass * state.filtered_acceleration;
    if (engine_.added_coriolis && body_.coriolis) {
      sum -= coriolis_matrix(body_.added_mass, velocity) * velocity;
    }
  }
  return sum;
}

Vector6 EngineRun::rate(const EngineState& state, const Vector6& force) const {
  Vector6 sum = forces(state, force);
  if (body_.coriolis) {
    sum -= coriolis_matrix(mass_, state.velocity) * state.velocity;
  }
  return inverse_mass_ * sum;
}

EngineState EngineRun::world_step(const EngineState& state, const Vector6& force) const {
  const Eigen::Vector3d& arm = body_.centre_of_gravity_m;
  const Vector6 sum = held(forces(state, force));
  const Eigen::Vector3d omega = state.velocity.tail<3>();
  const Eigen::Vector3d push = sum.head<3>();
  Eigen::Vector3d moment = sum.tail<3>() - arm.cross(push);
  if (body_.coriolis) {
    moment -= omega.cross(inertia_ * omega);
  }
  const Eigen::Vector3d centre = state.velocity.head<3>() + omega.cross(arm);
  const Eigen::Vector3d world = state.attitude * (centre + step_s_ / mass_kg_ * push);
  EngineState next = state;
  Vector6 turning = Vector6::Zero();
  turning.tail<3>() = omega + step_s_ * inertia_.inverse() * moment;
  turning = held(turning);
  const Eigen::Vector3d rotation = turning.tail<3>();
  next.attitude = turned(state.attitude, step_s_ * rotation);
  // Without Coriolis forces a velocity keeps its components in the body.
  const Eigen::Quaterniond& back = body_.coriolis ? next.attitude : state.attitude;
  next.velocity << back.conjugate() * world - rotation.cross(arm), rotation;
  next.velocity = held(next.velocity);
  return next;
}

EngineState EngineRun::runge_kutta_step(const EngineState& state, const Vector6& force) const {
  const auto moved = [&](const Vector6& acceleration, const Vector6& velocity, double time) {
    EngineState at = state;
    at.velocity = state.velocity + time * acceleration;
    at.attitude = turned(state.attitude, time * velocity.tail<3>());
    return at;
  };
  const double half = 0.5 * step_s_;
  const Vector6 k1 = rate(state, force);
  const EngineState second = moved(k1, state.velocity, half);
  const Vector6 k2 = rate(second, force);
  const EngineState third = moved(k2, second.velocity, half);
  const Vector6 k3 = rate(third, force);
  const EngineState last = moved(k3, third.velocity, step_s_);
  const Vector6 k4 = rate(last, force);
  const Vector6 mean = (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
  const Vector6 velocity =
      (state.velocity + 2.0 * second.velocity + 2.0 * third.velocity + last.velocity) / 6.0;
  return moved(mean, velocity, step_s_);
}

EngineState EngineRun::next(const EngineState& state, const Vector6& force) const {
  EngineState now = state;
  if (is_force(engine_.added_mass)) {
    now.filtered_acceleration = (1.0 - engine_.newest) * state.filtered_acceleration +
                                engine_.newest / step_s_ * (state.velocity - state.last_velocity);
  }
  EngineState next;
  switch (engine_.step) {
    case StepForm::runge_kutta:
      next = runge_kutta_step(now, force);
      break;
    case StepForm::world_euler:
      next = world_step(now, force);
      break;
    case StepForm::body_euler:
      next = now;
      next.velocity += step_s_ * rate(now, force);
      next.attitude = turned(now.attitude, step_s_ * next.velocity.tail<3>());
      break;
  }
  next.last_velocity = state.velocity;
  next.filtered_acceleration = now.filtered_acceleration;
  return next;
}

}  // namespace kelpie::simulator
