// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

// Decompositions of matrices and rotations, compiled once: every source that names one of Eigen's
// compiles the decomposition anew, which takes the compiler several seconds
// (src/library/core/decomposition.hpp has those of the library). All functions allocate.
namespace kelpie::simulator {

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);  ///< Moore and Penrose's.
Eigen::Index rank_of(const Eigen::MatrixXd& matrix);            ///< By a QR factor with pivots.

/// Eigenvalues, ascending, and eigenvectors of a symmetric matrix.
struct SymmetricPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
  bool converged = false;
};
SymmetricPairs symmetric_pairs(const Eigen::MatrixXd& symmetric);

/// The least rotation from body to world by which `down`, a vector of the body, points down (FRD).
Eigen::Quaterniond attitude_of(const Eigen::Vector3d& down);

}  // namespace kelpie::simulator
