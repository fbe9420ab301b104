// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/quantile.hpp"
#include "identify/tuning.hpp"
#include "identify/weak_form.hpp"

namespace kelpie {

/// Regression of the accelerations on all terms, axis by axis.
struct FreeFit {
  Eigen::MatrixXd coefficients;  ///< terms × axes
  Eigen::MatrixXd gram;          ///< Fᵀ W F, terms × terms
  Eigen::MatrixXd noise;         ///< covariance of the residuals
  /// Long-run covariance of the scores Σ_t w F_tk e_ta, axis fastest.
  Eigen::MatrixXd scores;
};

/// Least squares with Huber's weights; a window has the same weight on all axes. The covariance of
/// the scores takes the autocorrelation of errors into account: with `blocks` = 0 by lags (Andrews
/// 1991, Parzen kernel, AR(1) plug-in), else from the sums over so many pieces of the log (Liang &
/// Zeger 1986), which are independent where errors last less long than a piece. Requires more
/// windows than terms.
FreeFit fit_freely(const WeakRows& rows, Eigen::Index blocks = 0);

/// FreeFit::noise alone, without the covariance of the scores, which costs most.
Eigen::MatrixXd free_noise(const WeakRows& rows);

/// The 0.95 quantile of Student's t with kIdentification.pieces − 1 degrees over the normal's.
inline constexpr double kStudent = kIdentification.student90 / kNormal90;

/// Standard errors of the coefficients of one axis, from a fit by kIdentification.pieces: the roots
/// of the diagonal of (FᵀWF)⁻¹ S (FᵀWF)⁻¹ with the covariance S of the scores (Liang & Zeger 1986),
/// times kStudent.
Eigen::VectorXd sandwich_errors(const FreeFit& fit);

}  // namespace kelpie
