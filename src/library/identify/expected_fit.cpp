// SPDX-License-Identifier: Apache-2.0
#include "identify/expected_fit.hpp"

#include <algorithm>
#include <limits>

#include "core/eigen.hpp"
#include "core/normal_equations.hpp"
#include "core/quantile.hpp"

namespace kelpie {

double ExpectedFit::evidence(const WeakRows& drives, const std::vector<double>& first,
                             const std::vector<double>& second) const {
  const Information told = information(drives);
  Eigen::MatrixXd changes(told.hessian.rows(), 2);
  changes << as_vector(first), as_vector(second);
  const Eigen::MatrixXd pull = told.hessian * changes;
  const Eigen::Matrix2d curvature = changes.transpose() * pull;
  const Eigen::Matrix2d spread = misfit_ * changes.transpose() * told.gradients * changes +
                                 pull.transpose() * as_matrix(now().covariance) * pull;
  const Eigen::Matrix2d both = curvature * equilibrated_inverse(spread) * curvature.transpose();
  const double own = std::min(both(0, 0), both(1, 1));
  const double shared = both(0, 1) * both(0, 1) / std::max(both(0, 0) * both(1, 1), 1e-300);
  return 0.5 * own * std::max(0.0, 1.0 - shared);
}

double median_ratio(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below) {
  std::vector<double> ratios;
  for (Eigen::Index i = 0; i < above.rows(); ++i) {
    ratios.push_back(above(i, i) / std::max(below(i, i), std::numeric_limits<double>::min()));
  }
  return quantile(ratios, 0.5);
}

}  // namespace kelpie
