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

// A column that never moved has a variance of rounding errors of its mean at most.
bool moves(const Moments& moments, const Eigen::MatrixXd& sigma, Eigen::Index i) {
  return sigma(i, i) > 1e-24 * moments.mean()[i] * moments.mean()[i];
}

}  // namespace

Moments::Moments(std::size_t dimension, std::size_t memory)
    : memory_(memory),
      mean_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(dimension))),
      before_(mean_),
      scatter_(Eigen::MatrixXd::Zero(mean_.size(), mean_.size())) {}

void Moments::add(std::span<const double> x) {
  if (count_ == memory_) {
    scatter_ *= 1.0 - 1.0 / static_cast<double>(memory_);
    --count_;
  }
  ++count_;
  before_ = as_vector(x) - mean_;
  mean_ += before_ / static_cast<double>(count_);
  scatter_.noalias() += before_ * (as_vector(x) - mean_).transpose();
}

void Moments::assume(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                     std::size_t count) {
  count_ = count;
  mean_ = mean;
  scatter_ = static_cast<double>(count - 1) * covariance;
}

Eigen::MatrixXd Moments::covariance() const {
  const double freedom = count_ > 1 ? static_cast<double>(count_ - 1) : 1.0;
  return 0.5 * (scatter_ + scatter_.transpose()) / freedom;
}

void Moments::visit(Archive& archive) {
  archive.whole(count_);
  archive.require(count_ <= memory_, "counts more samples than it remembers");
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
  ScaledInput away = as_vector(z);
  for (Eigen::Index i = 0; i < away.size(); ++i) {
    away[i] -= whitening.row(i).head(i).dot(away.head(i));
    away[i] = whitening(i, i) > 0.0 ? away[i] / whitening(i, i) : 0.0;
  }
  return mean + away;
}

ScaledInput InputScaling::pull_back(std::span<const double> gradient) const {
  return whitening.triangularView<Eigen::Lower>().transpose() * ScaledInput(as_vector(gradient));
}

Eigen::MatrixXd InputScaling::covariance() const {
  Eigen::MatrixXd factor(whitening.rows(), whitening.cols());  // L of Σ = L Lᵀ, which is W⁻¹
  const Eigen::VectorXd unit = Eigen::VectorXd::Zero(mean.size());
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    Eigen::VectorXd one = unit;
    one[i] = 1.0;
    factor.col(i) = invert({one.data(), dimension()}) - mean;
  }
  return factor * factor.transpose();
}

std::optional<std::size_t> first_dependent(const Moments& moments, ScalingKind kind) {
  const Eigen::MatrixXd sigma = moments.covariance();
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(sigma.rows(), sigma.cols());
  for (Eigen::Index i = 0; i < sigma.rows(); ++i) {
    double rest = sigma(i, i);
    if (kind == ScalingKind::full) {
      for (Eigen::Index j = 0; j < i; ++j) {
        const double projected = factor.row(i).head(j).dot(factor.row(j).head(j));
        factor(i, j) = (sigma(i, j) - projected) / factor(j, j);
        rest -= factor(i, j) * factor(i, j);
      }
    }
    if (!(rest > kDependent * sigma(i, i)) || !moves(moments, sigma, i)) {
      return static_cast<std::size_t>(i);
    }
    factor(i, i) = std::sqrt(rest);
  }
  return std::nullopt;
}

double InputScaling::growth(const Moments& moments) const {
  const Eigen::MatrixXd sigma = moments.covariance();
  const Eigen::MatrixXd scaled = whitening * sigma * whitening.transpose();
  for (Eigen::Index i = 0; i < sigma.rows(); ++i) {
    if (whitening(i, i) == 0.0 && moves(moments, sigma, i)) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return std::sqrt(scaled.diagonal().maxCoeff());
}

std::optional<InputScaling> InputScaling::from(const Moments& moments, ScalingKind kind) {
  const Eigen::MatrixXd sigma = moments.covariance();
  InputScaling scaling{moments.mean(), Eigen::MatrixXd::Zero(sigma.rows(), sigma.cols())};
  if (kind == ScalingKind::diagonal) {
    for (Eigen::Index i = 0; i < sigma.rows(); ++i) {
      scaling.whitening(i, i) = moves(moments, sigma, i) ? 1.0 / std::sqrt(sigma(i, i)) : 0.0;
    }
    return scaling.whitening.diagonal().any() ? std::optional(scaling) : std::nullopt;
  }
  if (moments.count() < 2 || first_dependent(moments, kind)) {
    return std::nullopt;
  }
  const auto identity = Eigen::MatrixXd::Identity(sigma.rows(), sigma.cols());
  scaling.whitening = sigma.llt().matrixL().solve(identity);
  return scaling;
}

}  // namespace kelpie
