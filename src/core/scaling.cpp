// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/scaling.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace kelpie {
namespace {

constexpr double kDependent = 1e-10;

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

ConstVector as_vector(std::span<const double> x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}

}  // namespace

Moments::Moments(std::size_t dimension)
    : mean_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(dimension))),
      before_(mean_),
      scatter_(Eigen::MatrixXd::Zero(mean_.size(), mean_.size())) {}

void Moments::add(std::span<const double> x) {
  ++count_;
  before_ = as_vector(x) - mean_;
  mean_ += before_ / static_cast<double>(count_);
  scatter_.noalias() += before_ * (as_vector(x) - mean_).transpose();
}

Eigen::MatrixXd Moments::covariance() const {
  const double freedom = count_ > 1 ? static_cast<double>(count_ - 1) : 1.0;
  return 0.5 * (scatter_ + scatter_.transpose()) / freedom;
}

ScaledInput InputScaling::apply(std::span<const double> x) const {
  return whitening.triangularView<Eigen::Lower>() * ScaledInput(as_vector(x) - mean);
}

std::optional<std::size_t> first_dependent(const Moments& moments, ScalingKind kind) {
  const Eigen::MatrixXd sigma = moments.covariance();
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(sigma.rows(), sigma.cols());
  for (Eigen::Index i = 0; i < sigma.rows(); ++i) {
    // A column that never moved has a variance of rounding errors of its mean at most.
    const double rounding = 1e-24 * moments.mean()[i] * moments.mean()[i];
    double rest = sigma(i, i);
    if (kind == ScalingKind::full) {
      for (Eigen::Index j = 0; j < i; ++j) {
        const double projected = factor.row(i).head(j).dot(factor.row(j).head(j));
        factor(i, j) = (sigma(i, j) - projected) / factor(j, j);
        rest -= factor(i, j) * factor(i, j);
      }
    }
    if (!(rest > kDependent * sigma(i, i)) || !(sigma(i, i) > rounding)) {
      return static_cast<std::size_t>(i);
    }
    factor(i, i) = std::sqrt(rest);
  }
  return std::nullopt;
}

double InputScaling::drift(const Moments& moments) const {
  const Eigen::MatrixXd scaled = whitening * moments.covariance() * whitening.transpose();
  const Eigen::ArrayXd deviation = scaled.diagonal().array().sqrt();
  return std::max(deviation.maxCoeff(), 1.0 / deviation.minCoeff());
}

std::optional<InputScaling> InputScaling::from(const Moments& moments, ScalingKind kind) {
  if (moments.count() < 2 || first_dependent(moments, kind)) {
    return std::nullopt;
  }
  const Eigen::MatrixXd sigma = moments.covariance();
  const auto identity = Eigen::MatrixXd::Identity(sigma.rows(), sigma.cols());
  InputScaling scaling{moments.mean(), Eigen::MatrixXd{}};
  if (kind == ScalingKind::diagonal) {
    scaling.whitening = sigma.diagonal().cwiseSqrt().cwiseInverse().asDiagonal();
  } else {
    scaling.whitening = sigma.llt().matrixL().solve(identity);
  }
  return scaling;
}

}  // namespace kelpie
