// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "identify/free_fit.hpp"
#include "identify/structure.hpp"

namespace kelpie {

/// How parameters θ enter an equation M ν̇ = Θ(θ) f: docs/howto/identify.md, "How".
struct EquationStructure {
  std::function<StructureResidual(const Eigen::MatrixXd& coefficients,
                                  const Eigen::VectorXd& parameters)>
      residual;
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& parameters)> mass;
  std::vector<Eigen::Index> positive{};  ///< parameters that can't be negative
  /// Parameters m22, m23, m33 of a block of M that is positive definite, if any; `least`: its least
  /// eigenvalue.
  std::optional<std::array<Eigen::Index, 3>> block{};
  double least = 0.0;
};

/// The parameters with the least distance to free coefficients, and the curvature of the distance.
struct MinimumDistance {
  Eigen::VectorXd parameters;
  std::vector<Eigen::Index> free{};  ///< places of the estimated parameters
  std::vector<bool> at_bound{};      ///< per parameter
  bool indefinite = false;           ///< the block of M is at its bound
  Eigen::MatrixXd hessian{};         ///< of the distance by the free parameters
  double distance = 0.0;             ///< R'WR at the minimum, W = G ⊗ (M S Mᵀ)⁻¹
  bool converged = false;            ///< M and the metric are those of each other
};

/// Iterates from `start.parameters` until M and the metric converge; otherwise the nearest on the
/// way.
MinimumDistance minimise_distance(const FreeFit& fit, const EquationStructure& structure,
                                  MinimumDistance start);

/// The curvature of the distance by the free parameters at best.parameters.
Eigen::MatrixXd distance_hessian(const FreeFit& fit, const EquationStructure& structure,
                                 const MinimumDistance& best);

/// Covariance of the gradient of half the distance by the free parameters, from fit.scores: the
/// middle of the sandwich.
Eigen::MatrixXd gradient_covariance(const FreeFit& fit, const EquationStructure& structure,
                                    const MinimumDistance& best);

/// Errors of parameters from the covariance of the scores, and what chance alone would make of the
/// distance.
struct SandwichErrors {
  Eigen::MatrixXd covariance;  ///< of the free parameters
  double expected_distance = 1.0;
};

SandwichErrors sandwich(const FreeFit& fit, const EquationStructure& structure,
                        const MinimumDistance& best);

/// The distance over its expectation, at least 1.
double misfit_of(const MinimumDistance& best, const SandwichErrors& errors);

/// The distance over that of no forces at all: 1 where the structure explains nothing.
double unexplained_share(const FreeFit& fit, const MinimumDistance& best);

/// The fit in the plane for masses, drags and constant forces alone, with free coefficients of the
/// thrusters: convex for a given metric, 13 parameters.
FreeFit without_thrusters(const FreeFit& fit);

}  // namespace kelpie
