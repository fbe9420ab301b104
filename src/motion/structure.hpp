// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "motion/free_fit.hpp"

namespace kelpie {

// Fossen's equation M ν̇ = Θ(θ) f(ν, n) has one coefficient per axis and term; with free
// coefficients ν̇ = Bᵀ f in place of ν̇, what a parameter vector θ leaves is R(θ) = M Bᵀ − Θ(θ), 3 ×
// terms. θ is in the order of PlanarPlace.

/// R(θ), a column per term one after the other, and its derivatives.
struct StructureResidual {
  Eigen::VectorXd value;     ///< 3 terms
  Eigen::MatrixXd jacobian;  ///< 3 terms × parameters
};

StructureResidual structure_residual(const Eigen::MatrixXd& coefficients,
                                     const Eigen::VectorXd& parameters);

/// Of the vehicle alone: M.
Eigen::Matrix3d planar_mass(const Eigen::VectorXd& parameters);

/// Where the search starts: the thrusters' columns as the free fit has them, masses and drags of a
/// vehicle without any.
Eigen::VectorXd first_guess(const FreeFit& fit, std::size_t thrusters);

/// Thrusters' directions and coefficients that go best with the free columns under this M.
void guess_thrusters(const FreeFit& fit, Eigen::VectorXd& parameters);

}  // namespace kelpie
