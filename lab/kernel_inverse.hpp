// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "svr/kernel_matrix.hpp"

namespace kelpie::lab {

/// The inverse of K + λI of a dictionary's kernel matrix, kept while samples come and go: grown by
/// block inversion, shrunk by the Schur complement of what leaves. Numbering follows KernelMatrix.
/// The ridge λ keeps duplicated points apart: every Schur complement is at least λ.
/// Memory: capacity² doubles, allocated in the constructor; nothing else allocates.
class KernelInverse {
 public:
  /// Requires capacity > 0, ridge > 0.
  KernelInverse(std::size_t capacity, double ridge);

  std::size_t size() const { return size_; }
  /// K⁻¹_ij.
  double operator()(std::size_t i, std::size_t j) const { return inverse_(index(i), index(j)); }

  /// δ = κ(x, x) − kᵀ(K + λI)⁻¹k of a point with the kernel row k: the squared distance of its
  /// image from the span of the dictionary, 0 for one that says nothing new. Cost O(n²).
  double independence(std::span<const double> row, double self);

  /// The same of sample i against all others, read off the diagonal in O(1): 1/(K + λI)⁻¹_ii − λ.
  double independence(std::size_t i) const { return 1.0 / inverse_(index(i), index(i)) - ridge_; }

  void add(std::span<const double> row, double self);  ///< Requires a free place. Cost O(n²).
  void remove(std::size_t i);                          ///< Cost O(n²).

  /// A probe of the rounding errors so far: the largest |((K + λI) A − I) p| over fixed random
  /// signs p, A the inverse at hand; each entry is of the size of a row's norm in (K + λI) A − I.
  /// `kernel` is the matrix this is the inverse of. Cost O(n²).
  double residual(const KernelMatrix& kernel);

  /// Makes the inverse afresh, adding one sample after the other. Cost O(n³).
  void remake(const KernelMatrix& kernel);

  /// remake() when residual() exceeds a bound: 1e-7, or ten times what the last remake() could
  /// reach where the kernel matrix is too near to singular for that. Returns whether it did.
  bool keep_exact(const KernelMatrix& kernel);

 private:
  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

  double ridge_;
  std::size_t size_ = 0;
  double reachable_ = 0.0;  ///< the residual right after the last remake
  Eigen::MatrixXd inverse_;
  Eigen::VectorXd signs_;  ///< p
  Eigen::VectorXd work_;
  std::vector<double> row_;
};

}  // namespace kelpie::lab
