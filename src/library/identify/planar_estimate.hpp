// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "identify/minimum_distance.hpp"
#include "identify/weak_form.hpp"
#include "kelpie/identify/planar_fit.hpp"

namespace kelpie {

/// Places of the parameters that rows with this gram matrix of terms may tell: all but the surge
/// inertia and the coefficients of directions in which no thruster ran.
std::vector<Eigen::Index> sought_places(const Eigen::MatrixXd& gram, Eigen::Index parameters);

/// Parameters of these names and kinds, not estimated so far.
std::vector<FittedParameter> unknown_parameters(
    const std::vector<std::pair<std::string, ParameterKind>>& named);

/// A fit with estimates, errors and states of all parameters. `weak`: accelerations and terms, by
/// which a parameter's error is judged. `errors`: covariance of best.free, by chance alone.
PlanarFit planar_estimate(const std::vector<std::string>& thrusters, const WeakRows& weak,
                          const MinimumDistance& best, const Eigen::MatrixXd& errors,
                          double misfit);

/// Throws InputError with the masses and thrusters that are not told, if any.
void require_excitation(const PlanarFit& fit, const MinimumDistance& best);

}  // namespace kelpie
