// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/scaling.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/eigen.hpp"

namespace kelpie {
namespace {

constexpr double kDependent = 1e-10;

// A column that never moved has a variance of rounding errors of its mean at most.
bool moves(double variance, double mean) {
  return variance > 1e-24 * mean * mean;
}

}  // namespace

Moments::Moments(std::size_t dimension, std::size_t memory)
    : memory_(memory), mean_(dimension), before_(dimension), scatter_(dimension, dimension) {}

void Moments::add(std::span<const double> x) {
  auto mean = as_vector(mean_);
  auto before = as_vector(before_);
  auto scatter = as_matrix(scatter_);
  if (count_ == memory_) {
    scatter *= 1.0 - 1.0 / static_cast<double>(memory_);
    --count_;
  }
  ++count_;
  before = as_vector(x) - mean;
  mean += before / static_cast<double>(count_);
  scatter.noalias() += before * (as_vector(x) - mean).transpose();
}

double Moments::covariance(std::size_t i, std::size_t j) const {
  const double freedom = count_ > 1 ? static_cast<double>(count_ - 1) : 1.0;
  return 0.5 * (scatter_(i, j) + scatter_(j, i)) / freedom;
}

Matrix Moments::covariance() const {
  const double freedom = count_ > 1 ? static_cast<double>(count_ - 1) : 1.0;
  Matrix covariance(dimension(), dimension());
  const auto scatter = as_matrix(scatter_);
  as_matrix(covariance) = 0.5 * (scatter + scatter.transpose()) / freedom;
  return covariance;
}

void Moments::visit(Archive& archive) {
  archive.whole(count_);
  archive.require(count_ <= memory_, "counts more samples than it remembers");
  archive.numbers(mean_);
  archive.numbers(scatter_.values());
}

void AxisScaling::visit(Archive& archive, std::size_t inputs, std::size_t terms) {
  if (archive.loading()) {
    input.mean.resize(inputs);
    input.whitening = Matrix(inputs, inputs);
    term_scale.resize(terms);
  }
  archive.numbers(input.mean);
  archive.numbers(input.whitening.values());
  archive.number(target.mean);
  archive.number(target.scale);
  archive.numbers(term_scale);
  const auto positive = [](double scale) { return scale > 0.0; };
  archive.require(positive(target.scale) && std::ranges::all_of(term_scale, positive),
                  "holds a scale that isn't > 0");
}

ScaledInput InputScaling::apply(std::span<const double> x) const {
  ScaledInput away(x.size());
  as_vector(away) = as_vector(x) - as_vector(mean);
  ScaledInput z(x.size());
  as_vector(z).noalias() = as_matrix(whitening).triangularView<Eigen::Lower>() * as_vector(away);
  return z;
}

ScaledInput InputScaling::invert(std::span<const double> z) const {
  const auto factor = as_matrix(whitening);
  ScaledInput x(z.size());
  auto away = as_vector(x);
  away = as_vector(z);
  for (Eigen::Index i = 0; i < away.size(); ++i) {
    away[i] -= factor.row(i).head(i).dot(away.head(i));
    away[i] = factor(i, i) > 0.0 ? away[i] / factor(i, i) : 0.0;
  }
  away += as_vector(mean);
  return x;
}

ScaledInput InputScaling::pull_back(std::span<const double> gradient) const {
  ScaledInput by_x(gradient.size());
  as_vector(by_x).noalias() =
      as_matrix(whitening).transpose().triangularView<Eigen::Upper>() * as_vector(gradient);
  return by_x;
}

Matrix InputScaling::covariance() const {
  const auto size = static_cast<Eigen::Index>(dimension());
  Eigen::MatrixXd factor(size, size);  // L of Σ = L Lᵀ, which is W⁻¹
  std::vector<double> unit(dimension());
  for (std::size_t i = 0; i < dimension(); ++i) {
    unit[i] = 1.0;
    const ScaledInput x = invert(unit);
    factor.col(static_cast<Eigen::Index>(i)) = as_vector(x) - as_vector(mean);
    unit[i] = 0.0;
  }
  Matrix covariance(dimension(), dimension());
  as_matrix(covariance) = factor * factor.transpose();
  return covariance;
}

std::optional<std::size_t> first_dependent(const Moments& moments, ScalingKind kind) {
  const Matrix covariance = moments.covariance();
  const auto sigma = as_matrix(covariance);
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
    const auto input = static_cast<std::size_t>(i);
    if (!(rest > kDependent * sigma(i, i)) ||
        !moves(covariance(input, input), moments.mean()[input])) {
      return input;
    }
    factor(i, i) = std::sqrt(rest);
  }
  return std::nullopt;
}

bool InputScaling::take(const Moments& moments, ScalingKind kind) {
  const std::size_t inputs = moments.dimension();
  mean.assign(moments.mean().begin(), moments.mean().end());
  whitening = Matrix(inputs, inputs);
  if (kind == ScalingKind::full) {
    return take_full(moments);
  }
  bool any = false;
  for (std::size_t i = 0; i < inputs; ++i) {
    const double variance = moments.covariance(i, i);
    whitening(i, i) = moves(variance, mean[i]) ? 1.0 / std::sqrt(variance) : 0.0;
    any = any || whitening(i, i) != 0.0;
  }
  return any;
}

bool InputScaling::take_full(const Moments& moments) {
  if (moments.count() < 2 || first_dependent(moments, ScalingKind::full)) {
    return false;
  }
  const Matrix covariance = moments.covariance();
  const auto sigma = as_matrix(covariance);
  const auto identity = Eigen::MatrixXd::Identity(sigma.rows(), sigma.cols());
  as_matrix(whitening) = sigma.llt().matrixL().solve(identity);
  return true;
}

std::optional<InputScaling> InputScaling::from(const Moments& moments, ScalingKind kind) {
  InputScaling scaling;
  return scaling.take(moments, kind) ? std::optional(std::move(scaling)) : std::nullopt;
}

}  // namespace kelpie
