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

void Moments::visit(Archive& archive) {
  archive.whole(count_);
  archive.numbers({mean_.data(), dimension()});
  archive.numbers({scatter_.data(), dimension() * dimension()});
}

void AxisScaling::visit(Archive& archive, std::size_t inputs, std::size_t terms) {
  if (archive.loading()) {
    const auto size = static_cast<Eigen::Index>(inputs);
    input.mean.resize(size);
    input.whitening.resize(size, size);
    term_scale.resize(terms);
  }
  archive.numbers({input.mean.data(), inputs});
  archive.numbers({input.whitening.data(), inputs * inputs});
  archive.number(target.mean);
  archive.number(target.scale);
  archive.numbers(term_scale);
  const auto positive = [](double scale) { return scale > 0.0; };
  archive.require(positive(target.scale) && std::ranges::all_of(term_scale, positive),
                  "holds a scale that isn't > 0");
}

ScaledInput InputScaling::apply(std::span<const double> x) const {
  return whitening.triangularView<Eigen::Lower>() * ScaledInput(as_vector(x) - mean);
}

ScaledInput InputScaling::invert(std::span<const double> z) const {
  return mean + whitening.triangularView<Eigen::Lower>().solve(ScaledInput(as_vector(z)));
}

ScaledInput InputScaling::pull_back(std::span<const double> gradient) const {
  return whitening.triangularView<Eigen::Lower>().transpose() * ScaledInput(as_vector(gradient));
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
