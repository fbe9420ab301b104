// SPDX-License-Identifier: Apache-2.0
#include "lab/kernel_inverse.hpp"

#include <algorithm>
#include <cmath>

#include "kelpie/core/random.hpp"

namespace kelpie::lab {
namespace {

constexpr double kExact = 1e-7;

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

ConstVector as_vector(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

KernelInverse::KernelInverse(std::size_t capacity, double ridge)
    : ridge_(ridge),
      inverse_(Eigen::MatrixXd::Zero(index(capacity), index(capacity))),
      signs_(index(capacity)),
      work_(index(capacity)),
      row_(capacity) {
  RandomStream random(1, "probe");
  for (double& sign : signs_) {
    sign = random.below(2) == 0 ? -1.0 : 1.0;
  }
}

// Leaves a = (K + λI)⁻¹ k in work_.
double KernelInverse::independence(std::span<const double> row, double self) {
  const Eigen::Index n = index(size_);
  auto a = work_.head(n);
  a.noalias() = inverse_.topLeftCorner(n, n) * as_vector(row);
  // In exact numbers δ can't be negative: K is positive semidefinite.
  return std::max(self - a.dot(as_vector(row)), 0.0);
}

void KernelInverse::add(std::span<const double> row, double self) {
  const double schur = independence(row, self) + ridge_;
  const Eigen::Index n = index(size_);
  auto a = work_.head(n);
  inverse_.col(n).head(n) = -a / schur;
  inverse_.row(n).head(n) = inverse_.col(n).head(n).transpose();
  inverse_(n, n) = 1.0 / schur;
  // A product of two equal factors keeps the matrix symmetric to the last bit.
  a /= std::sqrt(schur);
  for (Eigen::Index j = 0; j < n; ++j) {
    inverse_.col(j).head(n) += a(j) * a;
  }
  ++size_;
}

void KernelInverse::remove(std::size_t i) {
  const Eigen::Index n = index(size_);
  const Eigen::Index gone = index(i);
  auto a = work_.head(n);
  a = inverse_.col(gone).head(n) / std::sqrt(inverse_(gone, gone));
  for (Eigen::Index j = 0; j < n; ++j) {
    inverse_.col(j).head(n) -= a(j) * a;
  }
  const Eigen::Index last = n - 1;
  inverse_.col(gone).head(n) = inverse_.col(last).head(n);
  inverse_.row(gone).head(n) = inverse_.row(last).head(n);
  inverse_(gone, gone) = inverse_(last, last);
  --size_;
}

double KernelInverse::residual(const KernelMatrix& kernel) {
  const Eigen::Index n = index(size_);
  auto solved = work_.head(n);
  solved.noalias() = inverse_.topLeftCorner(n, n) * signs_.head(n);
  double largest = 0.0;
  for (std::size_t i = 0; i < size_; ++i) {
    const double image = kernel.dot(i, {solved.data(), size_}) + ridge_ * solved(index(i));
    largest = std::max(largest, std::abs(image - signs_(index(i))));
  }
  return largest;
}

void KernelInverse::remake(const KernelMatrix& kernel) {
  size_ = 0;
  while (size_ < kernel.size()) {
    const std::span<double> row = std::span(row_).first(size_);
    kernel.row(size_, row);
    add(row, kernel(size_, size_));
  }
  reachable_ = residual(kernel);
}

bool KernelInverse::keep_exact(const KernelMatrix& kernel) {
  const bool drifted = !(residual(kernel) <= std::max(kExact, 10.0 * reachable_));
  if (drifted) {
    remake(kernel);
  }
  return drifted;
}

}  // namespace kelpie::lab
