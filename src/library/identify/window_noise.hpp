// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "identify/free_fit.hpp"
#include "identify/weak_form.hpp"

namespace kelpie {

/// Errors of the accelerations of windows: autocovariance per axis over lags of one stride, the
/// first of lag 0, until windows do not overlap. White noise of the velocities and white noise of
/// the accelerations (the process), in the shapes that the windows give them.
struct WindowNoise {
  std::vector<Eigen::VectorXd> autocovariance;
};

/// The two variances of each axis from the residuals of a free fit, by the quadratic estimator that
/// accounts for the terms fitted (MINQUE: Rao 1971): residuals of a short log are smaller than its
/// errors. Requires more windows than terms. Cost: windows × terms² × lags. Allocates.
WindowNoise window_noise(const WeakRows& rows, const FreeFit& fit, const WindowShape& shape);

/// Covariance of the scores Σ_t F_tk e_ta of windows one stride apart, terms × terms for each axis
/// a: errors of axes are independent.
std::vector<Eigen::MatrixXd> expected_axis_scores(const Eigen::MatrixXd& terms,
                                                  const WindowNoise& noise);

/// The same as FreeFit::scores.
Eigen::MatrixXd expected_scores(const Eigen::MatrixXd& terms, const WindowNoise& noise);

}  // namespace kelpie
