// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "motion/weak_form.hpp"

namespace kelpie {

/// Accelerations regressed on all terms, each axis by itself.
struct FreeFit {
  Eigen::MatrixXd coefficients;  ///< terms × 3
  Eigen::MatrixXd gram;          ///< Fᵀ W F, terms × terms
  Eigen::Matrix3d noise;         ///< covariance of what isn't explained
  /// Long-run covariance of the scores Σ_t w F_tk e_ta, axis fastest: what neighbouring errors have
  /// in common counts (Andrews 1991, Parzen kernel, AR(1) plug-in).
  Eigen::MatrixXd scores;
};

/// Least squares with Huber's weights, one per window for all axes. Requires more windows than
/// terms.
FreeFit fit_freely(const WeakRows& rows);

}  // namespace kelpie
