// SPDX-License-Identifier: Apache-2.0
#include "identify/structure.hpp"

#include <algorithm>
#include <cmath>

#include "kelpie/identify/planar_fit.hpp"

namespace kelpie {
namespace {

constexpr auto kPlace = [](std::size_t place) { return static_cast<Eigen::Index>(place); };
constexpr Eigen::Index kM11 = kPlace(PlanarPlace::surge_inertia);
constexpr Eigen::Index kM22 = kPlace(PlanarPlace::sway_inertia);
constexpr Eigen::Index kM23 = kPlace(PlanarPlace::sway_yaw_inertia);
constexpr Eigen::Index kM33 = kPlace(PlanarPlace::yaw_inertia);

// Adds what a parameter contributes to Θ's entry of an axis and a term.
class Entries {
 public:
  Entries(StructureResidual& residual, const Eigen::VectorXd& parameters)
      : residual_(residual), parameters_(parameters) {}

  void add(Eigen::Index axis, Eigen::Index term, Eigen::Index parameter, double factor) {
    residual_.value(3 * term + axis) -= factor * parameters_(parameter);
    residual_.jacobian(3 * term + axis, parameter) -= factor;
  }

 private:
  StructureResidual& residual_;
  const Eigen::VectorXd& parameters_;
};

void add_coriolis(Entries& entries) {
  entries.add(0, kTermVr, kM22, 1.0);
  entries.add(0, kTermRr, kM23, 1.0);
  entries.add(1, kTermUr, kM11, -1.0);
  entries.add(2, kTermUv, kM11, 1.0);
  entries.add(2, kTermUv, kM22, -1.0);
  entries.add(2, kTermUr, kM23, -1.0);
}

void add_thruster(Eigen::Index index, const Eigen::VectorXd& parameters,
                  StructureResidual& residual) {
  const Eigen::Index at = kPlace(PlanarPlace::thruster(static_cast<std::size_t>(index)));
  const double angle = parameters(at + 2);
  const Eigen::Vector3d axis(std::cos(angle), std::sin(angle), parameters(at + 3));
  const Eigen::Vector3d turned(-std::sin(angle), std::cos(angle), 0.0);
  for (Eigen::Index way = 0; way < 2; ++way) {
    const Eigen::Index row = 3 * (kTermThrusters + 2 * index + way);
    const double strength = parameters(at + way);
    residual.value.segment<3>(row) -= strength * axis;
    residual.jacobian.block<3, 1>(row, at + way) -= axis;
    residual.jacobian.block<3, 1>(row, at + 2) -= strength * turned;
    residual.jacobian(row + 2, at + 3) -= strength;
  }
}

}  // namespace

Eigen::Matrix3d planar_mass(const Eigen::VectorXd& parameters) {
  Eigen::Matrix3d mass = Eigen::Matrix3d::Zero();
  mass(0, 0) = parameters(kM11);
  mass(1, 1) = parameters(kM22);
  mass(1, 2) = mass(2, 1) = parameters(kM23);
  mass(2, 2) = parameters(kM33);
  return mass;
}

StructureResidual structure_residual(const Eigen::MatrixXd& coefficients,
                                     const Eigen::VectorXd& parameters) {
  const Eigen::Index terms = coefficients.rows();
  StructureResidual residual{Eigen::VectorXd(3 * terms),
                             Eigen::MatrixXd::Zero(3 * terms, parameters.size())};
  const Eigen::Matrix3d mass = planar_mass(parameters);
  for (Eigen::Index term = 0; term < terms; ++term) {
    const Eigen::RowVector3d b = coefficients.row(term);
    residual.value.segment<3>(3 * term) = mass * b.transpose();
    residual.jacobian(3 * term, kM11) = b(0);
    residual.jacobian(3 * term + 1, kM22) = b(1);
    residual.jacobian(3 * term + 1, kM23) = b(2);
    residual.jacobian(3 * term + 2, kM23) = b(1);
    residual.jacobian(3 * term + 2, kM33) = b(2);
  }
  Entries entries(residual, parameters);
  add_coriolis(entries);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    entries.add(axis, kTermLinear + axis, kPlace(PlanarPlace::linear_drag) + axis, -1.0);
    entries.add(axis, kTermQuadratic + axis, kPlace(PlanarPlace::quadratic_drag) + axis, -1.0);
    entries.add(axis, kTermOne, kPlace(PlanarPlace::constant_force) + axis, 1.0);
  }
  for (Eigen::Index i = 0; i < (terms - kTermThrusters) / 2; ++i) {
    add_thruster(i, parameters, residual);
  }
  return residual;
}

void guess_thrusters(const FreeFit& fit, Eigen::VectorXd& parameters) {
  const Eigen::Matrix3d mass = planar_mass(parameters);
  for (Eigen::Index i = 0; i < (fit.coefficients.rows() - kTermThrusters) / 2; ++i) {
    const Eigen::Index term = kTermThrusters + 2 * i;
    const Eigen::Index at = kPlace(PlanarPlace::thruster(static_cast<std::size_t>(i)));
    const Eigen::Vector3d forward = mass * fit.coefficients.row(term).transpose();
    const Eigen::Vector3d reverse = mass * fit.coefficients.row(term + 1).transpose();
    const Eigen::Vector3d both =
        fit.gram(term, term) * forward + fit.gram(term + 1, term + 1) * reverse;
    const Eigen::Vector2d direction = both.head<2>().normalized();
    parameters(at) = std::max(0.0, forward.head<2>().dot(direction));
    parameters(at + 1) = std::max(0.0, reverse.head<2>().dot(direction));
    parameters(at + 2) = std::atan2(direction(1), direction(0));
    parameters(at + 3) = both(2) / both.head<2>().norm();
  }
}

Eigen::VectorXd first_guess(const FreeFit& fit, std::size_t thrusters) {
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(kPlace(PlanarPlace::thruster(thrusters)));
  parameters(kM11) = 1.0;
  parameters(kM22) = 1.0;
  // A yaw inertia at which accelerations of sway and yaw weigh alike.
  parameters(kM33) = fit.noise(1, 1) / std::max(fit.noise(2, 2), 1e-300);
  guess_thrusters(fit, parameters);
  return parameters;
}

}  // namespace kelpie
