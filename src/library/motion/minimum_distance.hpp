// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/free_fit.hpp"

namespace kelpie {

/// The parameters of Fossen's equation with the least distance to free coefficients, and the
/// curvature of the distance.
struct MinimumDistance {
  Eigen::VectorXd parameters;        ///< in the order of PlanarPlace
  std::vector<Eigen::Index> free{};  ///< places of the estimated parameters
  std::vector<bool> at_bound{};      ///< per parameter
  bool indefinite = false;           ///< M ≻ 0 is an active constraint
  Eigen::MatrixXd hessian{};         ///< of the distance by the free parameters
  double distance = 0.0;             ///< R'WR at the minimum, W = G ⊗ (M S Mᵀ)⁻¹
};

/// Iterates from `start.parameters` until M and the metric converge.
MinimumDistance minimise_distance(const FreeFit& fit, MinimumDistance start);

/// The fit for masses, drags and constant forces alone, with free coefficients of the thrusters:
/// convex for a given metric, 13 parameters.
FreeFit without_thrusters(const FreeFit& fit);

/// W of MinimumDistance, 3 terms × 3 terms.
Eigen::MatrixXd distance_metric(const FreeFit& fit, const Eigen::Matrix3d& mass);

}  // namespace kelpie
