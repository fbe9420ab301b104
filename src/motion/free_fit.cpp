// SPDX-License-Identifier: Apache-2.0
#include "motion/free_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/quantile.hpp"

namespace kelpie {
namespace {

constexpr int kReweighted = 6;
constexpr double kHuber = 2.5;  // robust standard deviations; beyond, windows count less
constexpr double kNormalMad = 1.4826;
constexpr double kColumnRidge = 1e-12;  // against a column's own size
constexpr double kMostRho = 0.97;       // a bandwidth follows from it
constexpr Eigen::Index kLagShare = 10;  // no longer than a tenth of the windows

double robust_scale(const Eigen::VectorXd& residuals) {
  std::vector<double> sizes(residuals.data(), residuals.data() + residuals.size());
  for (double& size : sizes) {
    size = std::abs(size);
  }
  return std::max(kNormalMad * quantile(sizes, 0.5), std::numeric_limits<double>::min());
}

Eigen::VectorXd huber_weights(const Eigen::MatrixXd& residuals) {
  Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(residuals.rows());
  for (Eigen::Index axis = 0; axis < residuals.cols(); ++axis) {
    largest = largest.max(residuals.col(axis).array().abs() / robust_scale(residuals.col(axis)));
  }
  return (largest > kHuber).select(kHuber / largest.max(kHuber), 1.0).matrix();
}

// Lags that count, as many as Andrews' rule for the Parzen kernel wants.
Eigen::Index lags_of(const Eigen::MatrixXd& residuals) {
  double curvature = 0.0;
  for (Eigen::Index axis = 0; axis < residuals.cols(); ++axis) {
    const Eigen::VectorXd e = residuals.col(axis);
    const Eigen::Index n = e.size();
    const double rho = std::clamp(e.tail(n - 1).dot(e.head(n - 1)) /
                                      std::max(e.squaredNorm(), std::numeric_limits<double>::min()),
                                  -kMostRho, kMostRho);
    curvature += 4.0 * rho * rho / std::pow(1.0 - rho, 4.0) / 3.0;
  }
  const auto n = static_cast<double>(residuals.rows());
  const auto lags = static_cast<Eigen::Index>(std::ceil(2.6614 * std::pow(curvature * n, 0.2)));
  return std::min(lags, residuals.rows() / kLagShare);
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

}  // namespace

Eigen::MatrixXd inverse_of_gram(const Eigen::MatrixXd& gram) {
  const Eigen::VectorXd size =
      gram.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = size.asDiagonal() * gram * size.asDiagonal();
  scaled.diagonal().array() += kColumnRidge;
  for (Eigen::Index i = 0; i < gram.rows(); ++i) {
    if (gram(i, i) <= 0.0) {
      scaled(i, i) = 1.0;
    }
  }
  const Eigen::MatrixXd inverse =
      scaled.ldlt().solve(Eigen::MatrixXd::Identity(gram.rows(), gram.rows()));
  return size.asDiagonal() * inverse * size.asDiagonal();
}

FreeFit fit_freely(const WeakRows& rows) {
  FreeFit fit;
  const Eigen::Index n = rows.terms.rows();
  const Eigen::Index terms = rows.terms.cols();
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(n);
  Eigen::MatrixXd residuals;
  for (int round = 0; round <= kReweighted; ++round) {
    const Eigen::MatrixXd weighted = weights.asDiagonal() * rows.terms;
    fit.gram = rows.terms.transpose() * weighted;
    fit.coefficients = inverse_of_gram(fit.gram) * (weighted.transpose() * rows.acceleration);
    residuals = rows.acceleration - rows.terms * fit.coefficients;
    if (round < kReweighted) {
      weights = huber_weights(residuals);
    }
  }
  fit.noise = residuals.transpose() * weights.asDiagonal() * residuals /
              std::max<double>(1.0, weights.sum() - static_cast<double>(terms));
  fit.noise.diagonal().array() += std::numeric_limits<double>::min();
  Eigen::MatrixXd scores(n, 3 * terms);
  for (Eigen::Index term = 0; term < terms; ++term) {
    scores.middleCols(3 * term, 3) =
        (weights.cwiseProduct(rows.terms.col(term))).asDiagonal() * residuals;
  }
  fit.scores = long_run(scores, lags_of(residuals));
  return fit;
}

}  // namespace kelpie
