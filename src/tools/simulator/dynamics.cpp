// SPDX-License-Identifier: Apache-2.0
#include "simulator/dynamics.hpp"

#include <cmath>

#include "simulator/decomposition.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {
namespace {

// S(a) b = a × b
Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  return (Eigen::Matrix3d() << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0)
      .finished();
}

}  // namespace

Matrix6 rigid_body_mass(double mass, const Eigen::Vector3d& centre,
                        const Eigen::Matrix3d& inertia) {
  const Eigen::Matrix3d arm = skew(centre);
  Matrix6 matrix;
  matrix.topLeftCorner<3, 3>() = mass * Eigen::Matrix3d::Identity();
  matrix.topRightCorner<3, 3>() = -mass * arm;
  matrix.bottomLeftCorner<3, 3>() = mass * arm;
  matrix.bottomRightCorner<3, 3>() = inertia - mass * arm * arm;
  return matrix;
}

Plant make_plant(const VehicleParameters& vehicle, const Configuration& configuration) {
  const Payload& payload = configuration.payload;
  Plant plant;
  plant.mass =
      rigid_body_mass(vehicle.mass_kg, vehicle.centre_of_gravity_m, vehicle.inertia_kg_m2) +
      vehicle.added_mass +
      rigid_body_mass(payload.mass_kg, payload.position_m, payload.inertia_kg_m2) +
      payload.added_mass;
  plant.linear_damping = vehicle.linear_damping.cwiseProduct(configuration.damping_factor);
  plant.quadratic_damping = vehicle.quadratic_damping.cwiseProduct(configuration.damping_factor);

  const double weight = vehicle.mass_kg * kGravity;
  const double buoyancy = weight + vehicle.net_buoyancy_n;
  const double payload_net = payload.mass_kg * kGravity - payload.buoyancy_n;
  plant.net_weight_n = payload_net - vehicle.net_buoyancy_n;
  plant.weight_moment_nm = weight * vehicle.centre_of_gravity_m -
                           buoyancy * vehicle.centre_of_buoyancy_m +
                           payload_net * payload.position_m;

  const auto count = static_cast<Eigen::Index>(vehicle.thrusters.size());
  plant.forward.resize(count);
  plant.reverse.resize(count);
  plant.thrust_axes = thrust_axes(vehicle.thrusters);
  for (Eigen::Index i = 0; i < count; ++i) {
    plant.forward(i) = vehicle.thrusters[static_cast<std::size_t>(i)].forward;
    plant.reverse(i) = vehicle.thrusters[static_cast<std::size_t>(i)].reverse;
    plant.thrust_axes.col(i) *= configuration.effectiveness(i);
  }
  plant.pull << configuration.pull_n, configuration.pull_position_m.cross(configuration.pull_n);
  return plant;
}

Plant blend(const Plant& from, const Plant& to, double share) {
  const auto between = [share](const auto& a, const auto& b) {
    return ((1.0 - share) * a + share * b).eval();
  };
  Plant plant = to;
  plant.mass = between(from.mass, to.mass);
  plant.linear_damping = between(from.linear_damping, to.linear_damping);
  plant.quadratic_damping = between(from.quadratic_damping, to.quadratic_damping);
  plant.net_weight_n = std::lerp(from.net_weight_n, to.net_weight_n, share);
  plant.weight_moment_nm = between(from.weight_moment_nm, to.weight_moment_nm);
  plant.thrust_axes = between(from.thrust_axes, to.thrust_axes);
  plant.pull = between(from.pull, to.pull);
  return plant;
}

bool is_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  return matrix.allFinite() && (matrix - matrix.transpose()).cwiseAbs().maxCoeff() <=
                                   1e-12 * matrix.cwiseAbs().maxCoeff();
}

bool is_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const auto [values, vectors, converged] = symmetric_pairs(matrix);
  return converged && values(0) > 1e-9 * values(values.size() - 1);
}

Matrix6 coriolis_matrix(const Matrix6& mass, const Vector6& velocity) {
  const Vector6 momentum = mass * velocity;
  const Eigen::Matrix3d linear = skew(momentum.head<3>());
  Matrix6 matrix = Matrix6::Zero();
  matrix.topRightCorner<3, 3>() = -linear;
  matrix.bottomLeftCorner<3, 3>() = -linear;
  matrix.bottomRightCorner<3, 3>() = -skew(momentum.tail<3>());
  return matrix;
}

// NOLINTNEXTLINE(modernize-pass-by-value): a vector of three numbers has nothing to move
Dynamics::Dynamics(const Plant& plant, const Eigen::Vector3d& current_m_s)
    : plant_(plant),
      inverse_mass_(plant.mass.llt().solve(Matrix6::Identity())),
      current_(current_m_s) {}

Vector6 Dynamics::acceleration(const Eigen::Quaterniond& attitude, const Vector6& velocity,
                               const RotorSpeeds& speeds_rps) const {
  const Eigen::Matrix3d to_body = attitude.toRotationMatrix().transpose();
  const Eigen::Vector3d current = to_body * current_;
  Vector6 relative = velocity;
  relative.head<3>() -= current;

  const Vector6 damping =
      (plant_.linear_damping + plant_.quadratic_damping.cwiseProduct(relative.cwiseAbs()))
          .cwiseProduct(relative);
  Vector6 acceleration =
      inverse_mass_ * (thruster_forces(speeds_rps) + restoring_forces(to_body.col(2)) +
                       plant_.pull - coriolis_matrix(plant_.mass, relative) * relative - damping);
  // Solved for ν_r so far. A current constant in the world turns in the body: ν̇ = ν̇_r − ω × v_c.
  acceleration.head<3>() -= velocity.tail<3>().cross(current);
  return acceleration;
}

Vector6 Dynamics::thruster_forces(const RotorSpeeds& speeds_rps) const {
  Vector6 forces = Vector6::Zero();
  for (Eigen::Index i = 0; i < speeds_rps.size(); ++i) {
    const double speed = speeds_rps(i);
    const double coefficient = speed < 0.0 ? plant_.reverse(i) : plant_.forward(i);
    forces += coefficient * speed * std::abs(speed) * plant_.thrust_axes.col(i);
  }
  return thrust_factor_ * forces;
}

Vector6 Dynamics::restoring_forces(const Eigen::Vector3d& down) const {
  return (Vector6() << plant_.net_weight_n * down, plant_.weight_moment_nm.cross(down)).finished();
}

}  // namespace kelpie::simulator
