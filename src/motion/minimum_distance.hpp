// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "motion/free_fit.hpp"

namespace kelpie {

/// Which parameters of Fossen's equation go best with free coefficients, and how the distance
/// bends around them.
struct MinimumDistance {
  Eigen::VectorXd parameters;        ///< in the order of PlanarPlace
  std::vector<Eigen::Index> free{};  ///< those that are sought; the others stay as given
  std::vector<bool> at_bound{};      ///< per parameter
  bool indefinite = false;           ///< M ≻ 0 is an active constraint
  Eigen::MatrixXd hessian{};         ///< of the free ones
  double distance = 0.0;             ///< R'WR at the minimum, W = G ⊗ (M S Mᵀ)⁻¹
};

/// Starts at `start.parameters`. The metric follows M until neither moves.
MinimumDistance minimise_distance(const FreeFit& fit, MinimumDistance start);

/// The fit with thrusters' columns left free: a program of masses, drags and constant forces alone,
/// which is convex for a given metric. Start and result have 13 parameters.
FreeFit without_thrusters(const FreeFit& fit);

/// W of MinimumDistance, 3 terms × 3 terms.
Eigen::MatrixXd distance_metric(const FreeFit& fit, const Eigen::Matrix3d& mass);

}  // namespace kelpie
