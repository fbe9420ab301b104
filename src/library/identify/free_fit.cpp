// SPDX-License-Identifier: Apache-2.0
#include "identify/free_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/normal_equations.hpp"
#include "core/quantile.hpp"
#include "identify/tuning.hpp"

namespace kelpie {
namespace {

double deviation_of(const Eigen::VectorXd& residuals) {
  std::vector<double> sizes(residuals.data(), residuals.data() + residuals.size());
  for (double& size : sizes) {
    size = std::abs(size);
  }
  return std::max(robust_deviation(sizes), std::numeric_limits<double>::min());
}

Eigen::VectorXd huber_weights(const Eigen::MatrixXd& residuals) {
  Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(residuals.rows());
  for (Eigen::Index axis = 0; axis < residuals.cols(); ++axis) {
    largest = largest.max(residuals.col(axis).array().abs() / deviation_of(residuals.col(axis)));
  }
  const double limit = kIdentification.huber_sigmas;
  return (largest > limit).select(limit / largest.max(limit), 1.0).matrix();
}

// Lags that count, as many as Andrews' rule for the Parzen kernel wants.
Eigen::Index lags_of(const Eigen::MatrixXd& residuals) {
  const auto axes = static_cast<double>(residuals.cols());
  double curvature = 0.0;
  for (Eigen::Index axis = 0; axis < residuals.cols(); ++axis) {
    const Eigen::VectorXd e = residuals.col(axis);
    const Eigen::Index n = e.size();
    const double rho = std::clamp(e.tail(n - 1).dot(e.head(n - 1)) /
                                      std::max(e.squaredNorm(), std::numeric_limits<double>::min()),
                                  -kIdentification.most_rho, kIdentification.most_rho);
    curvature += 4.0 * rho * rho / std::pow(1.0 - rho, 4.0) / axes;
  }
  const auto n = static_cast<double>(residuals.rows());
  const auto lags = static_cast<Eigen::Index>(std::ceil(2.6614 * std::pow(curvature * n, 0.2)));
  return std::min(lags, residuals.rows() / kIdentification.lag_divisor);
}

double parzen(double z) {
  return z <= 0.5 ? 1.0 - 6.0 * z * z * (1.0 - z) : 2.0 * std::pow(1.0 - z, 3.0);
}

Eigen::MatrixXd long_run(const Eigen::MatrixXd& scores, Eigen::Index lags) {
  Eigen::MatrixXd sum = scores.transpose() * scores;
  const Eigen::Index n = scores.rows();
  for (Eigen::Index lag = 1; lag <= lags; ++lag) {
    const double weight = parzen(static_cast<double>(lag) / static_cast<double>(lags + 1));
    const Eigen::MatrixXd cross =
        weight * (scores.bottomRows(n - lag).transpose() * scores.topRows(n - lag));
    sum += cross + cross.transpose();
  }
  return sum;
}

Eigen::MatrixXd between_blocks(const Eigen::MatrixXd& scores, Eigen::Index blocks) {
  Eigen::MatrixXd sums(blocks, scores.cols());
  for (Eigen::Index block = 0; block < blocks; ++block) {
    const Eigen::Index begin = block * scores.rows() / blocks;
    const Eigen::Index end = (block + 1) * scores.rows() / blocks;
    sums.row(block) = scores.middleRows(begin, end - begin).colwise().sum();
  }
  const auto count = static_cast<double>(blocks);
  return count / (count - 1.0) * (sums.transpose() * sums);
}

// Least squares with Huber's weights, without the covariance of the scores.
struct Regression {
  FreeFit fit;
  Eigen::VectorXd weights;
  Eigen::MatrixXd residuals;
};

Regression regress(const WeakRows& rows) {
  const Eigen::Index n = rows.terms.rows();
  Regression found{.fit = {}, .weights = Eigen::VectorXd::Ones(n), .residuals = {}};
  FreeFit& fit = found.fit;
  for (int round = 0; round <= kIdentification.reweighted; ++round) {
    const NormalEquations sums =
        NormalEquations::of_weighted(rows.terms, rows.acceleration, found.weights);
    fit.gram = sums.gram();
    fit.coefficients = equilibrated_inverse(fit.gram) * sums.moments();
    found.residuals = rows.acceleration - rows.terms * fit.coefficients;
    if (round < kIdentification.reweighted) {
      found.weights = huber_weights(found.residuals);
    }
  }
  const double free = found.weights.sum() - static_cast<double>(rows.terms.cols());
  fit.noise = found.residuals.transpose() * found.weights.asDiagonal() * found.residuals /
              std::max(1.0, free);
  fit.noise.diagonal().array() += std::numeric_limits<double>::min();
  return found;
}

}  // namespace

Eigen::MatrixXd free_noise(const WeakRows& rows) {
  return regress(rows).fit.noise;
}

FreeFit fit_freely(const WeakRows& rows, Eigen::Index blocks) {
  auto [fit, weights, residuals] = regress(rows);
  const Eigen::Index n = rows.terms.rows();
  const Eigen::Index terms = rows.terms.cols();
  const Eigen::Index axes = rows.acceleration.cols();
  Eigen::MatrixXd scores(n, axes * terms);
  for (Eigen::Index term = 0; term < terms; ++term) {
    scores.middleCols(axes * term, axes) =
        (weights.cwiseProduct(rows.terms.col(term))).asDiagonal() * residuals;
  }
  fit.scores = blocks > 0 ? between_blocks(scores, blocks) : long_run(scores, lags_of(residuals));
  return fit;
}

Eigen::VectorXd sandwich_errors(const FreeFit& fit) {
  const Eigen::MatrixXd inverse = equilibrated_inverse(fit.gram);
  return kStudent * (inverse * fit.scores * inverse).diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace kelpie
