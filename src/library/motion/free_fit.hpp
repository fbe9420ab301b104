// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "motion/weak_form.hpp"

namespace kelpie {

/// Regression of the accelerations on all terms, axis by axis.
struct FreeFit {
  Eigen::MatrixXd coefficients;  ///< terms × 3
  Eigen::MatrixXd gram;          ///< Fᵀ W F, terms × terms
  Eigen::Matrix3d noise;         ///< covariance of the residuals
  /// Long-run covariance of the scores Σ_t w F_tk e_ta, axis fastest, with the autocorrelation of
  /// the errors (Andrews 1991, Parzen kernel, AR(1) plug-in).
  Eigen::MatrixXd scores;
};

/// Least squares with Huber's weights; a window has the same weight on all axes. Requires more
/// windows than terms.
FreeFit fit_freely(const WeakRows& rows);

}  // namespace kelpie
