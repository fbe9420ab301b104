// SPDX-License-Identifier: Apache-2.0
// Oracles of linear algebra, compiled once: Eigen's decompositions take 3 to 8 s in every source.
#pragma once

#include <Eigen/Core>

namespace kelpie::testing {

/// The x of the least (a x − b)², by QR with pivots; a has full rank of columns.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd inverse(const Eigen::MatrixXd& square);

}  // namespace kelpie::testing
