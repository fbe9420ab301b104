// SPDX-License-Identifier: Apache-2.0
#include "linear_algebra.hpp"

#include <Eigen/QR>

namespace kelpie::testing {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& square) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Identity(square.rows(), square.cols());
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    columns.col(i) = least_squares(square, columns.col(i));
  }
  return columns;
}

}  // namespace kelpie::testing
