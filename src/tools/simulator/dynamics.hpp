// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>

#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// The coefficients of
///   M ν̇_r + C(ν_r) ν_r + (D_L + D_Q |ν_r|) ν_r + g(η) = f Σ_i e_i K±_i n_i|n_i| a_i + τ_pull
/// for a vehicle in one configuration. The equation is linear in every coefficient.
struct Plant {
  Matrix6 mass = Matrix6::Zero();  ///< rigid body and added mass, about the origin
  Vector6 linear_damping = Vector6::Zero();
  Vector6 quadratic_damping = Vector6::Zero();
  double net_weight_n = 0.0;                                   ///< weight − buoyancy
  Eigen::Vector3d weight_moment_nm = Eigen::Vector3d::Zero();  ///< W r_g − B r_b
  RotorSpeeds forward;                                         ///< K+ of each thruster
  RotorSpeeds reverse;                                         ///< K− of each thruster
  ThrustAxes thrust_axes;                                      ///< columns e_i a_i
  Vector6 pull = Vector6::Zero();                              ///< constant in the body
};

/// The mass matrix about the origin of a rigid body that is given about its centre of gravity.
Matrix6 rigid_body_mass(double mass, const Eigen::Vector3d& centre, const Eigen::Matrix3d& inertia);

/// Ensures: the mass matrix is symmetric if the added masses are. A payload of negative mass may
/// make the matrix indefinite, see is_positive_definite().
Plant make_plant(const VehicleParameters& vehicle, const Configuration& configuration);

/// Linear interpolation of two plants with the same thrusters, 0 ≤ share ≤ 1.
Plant blend(const Plant& from, const Plant& to, double share);

/// Whether `matrix` is symmetric to within rounding (1e-12 of its largest entry).
bool is_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Whether every eigenvalue of the symmetric `matrix` is above 1e-9 of the largest.
bool is_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// C(ν) in Kirchhoff's form from the full mass matrix (Fossen 2011, theorem 3.2).
/// Ensures: skew-symmetric for any symmetric `mass`.
Matrix6 coriolis_matrix(const Matrix6& mass, const Vector6& velocity);

/// Accelerations of a vehicle. Doesn't allocate after construction.
class Dynamics {
 public:
  /// `current_m_s`: velocity of the water, NED, constant and free of rotation.
  /// Requires a positive definite mass matrix.
  explicit Dynamics(const Plant& plant,
                    const Eigen::Vector3d& current_m_s = Eigen::Vector3d::Zero());

  /// Derivative of `velocity` (body frame, over ground). `attitude` rotates body into world
  /// coordinates.
  Vector6 acceleration(const Eigen::Quaterniond& attitude, const Vector6& velocity,
                       const RotorSpeeds& speeds_rps) const;

  /// f: factor of the supply voltage on every thrust; 1 at the start.
  void set_thrust_factor(double factor) { thrust_factor_ = factor; }
  double thrust_factor() const { return thrust_factor_; }

  const Plant& plant() const { return plant_; }

 private:
  Vector6 thruster_forces(const RotorSpeeds& speeds_rps) const;
  Vector6 restoring_forces(const Eigen::Vector3d& down) const;

  Plant plant_;
  Matrix6 inverse_mass_;
  Eigen::Vector3d current_;
  double thrust_factor_ = 1.0;
};

}  // namespace kelpie::simulator
