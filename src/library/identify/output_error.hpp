// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "identify/pose_motion.hpp"

namespace kelpie {

/// Estimates of a vehicle and of the starts of its path's pieces.
struct PathEstimate {
  Eigen::VectorXd parameters;     ///< PathPlace
  std::vector<PoseState> starts;  ///< of each piece
  BetweenRows between = BetweenRows::ramps;
};

/// Measured less simulated poses: a matrix of 3 × rows per piece; NaN where not measured.
using PoseErrors = std::vector<Eigen::Matrix3Xd>;

/// The measurements that count: noise of x, y and heading; infinite: not counted.
using PoseNoise = Eigen::Vector3d;

inline constexpr double kNotCounted = std::numeric_limits<double>::infinity();

PoseErrors pose_errors(const std::vector<PathPiece>& pieces, const PathEstimate& estimate);

/// Robust deviations of the errors; x and y are alike. Where `counted` is infinite, the result is.
PoseNoise noise_of(const PoseErrors& errors, const PoseNoise& counted);

/// Minimises Σ ρ(error / noise) with Huber's ρ over the parameters `sought` and all starts, by
/// Levenberg-Marquardt steps with bounds, the starts eliminated from the normal equations. The
/// noise follows the errors, in a few rounds. Returns the noise. `least_gain`: share of the sum
/// that ends a round.
PoseNoise minimise_output_errors(const std::vector<PathPiece>& pieces,
                                 const std::vector<Eigen::Index>& sought, const PoseNoise& counted,
                                 double least_gain, PathEstimate& estimate);

/// The information on the parameters `sought` with all starts unknown: the inverse of their
/// covariance.
Eigen::MatrixXd output_information(const std::vector<PathPiece>& pieces,
                                   const std::vector<Eigen::Index>& sought, const PoseNoise& noise,
                                   const PathEstimate& estimate);

}  // namespace kelpie
