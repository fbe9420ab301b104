// SPDX-License-Identifier: Apache-2.0
#include "simulator/decomposition.hpp"

#include <Eigen/Dense>

namespace kelpie::simulator {

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::Index rank_of(const Eigen::MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().rank();
}

SymmetricPairs symmetric_pairs(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors(), solver.info() == Eigen::Success};
}

Eigen::Quaterniond attitude_of(const Eigen::Vector3d& down) {
  return Eigen::Quaterniond::FromTwoVectors(down, Eigen::Vector3d::UnitZ());
}

}  // namespace kelpie::simulator
