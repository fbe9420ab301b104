// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "identify/free_fit.hpp"

namespace kelpie {

// Fossen's equation is M ν̇ = Θ(θ) f(ν, n), with a coefficient per axis and term. With ν̇ = Bᵀ f from
// the free fit, the residual of a parameter vector θ is R(θ) = M Bᵀ − Θ(θ), 3 × terms. θ is in the
// order of PlanarPlace.

/// R(θ) column by column (a column per term), and the derivatives.
struct StructureResidual {
  Eigen::VectorXd value;     ///< 3 terms
  Eigen::MatrixXd jacobian;  ///< 3 terms × parameters
};

StructureResidual structure_residual(const Eigen::MatrixXd& coefficients,
                                     const Eigen::VectorXd& parameters);

/// M.
Eigen::Matrix3d planar_mass(const Eigen::VectorXd& parameters);

/// Start of the iteration: thrusters from the free fit, unit masses, no drag.
Eigen::VectorXd first_guess(const FreeFit& fit, std::size_t thrusters);

/// Sets directions and coefficients of the thrusters from the free fit, for the M in `parameters`.
void guess_thrusters(const FreeFit& fit, Eigen::VectorXd& parameters);

}  // namespace kelpie
