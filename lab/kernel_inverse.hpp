// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "svr/kernel_matrix.hpp"

namespace kelpie::lab {

/// The inverse of K + λI of a dictionary's kernel matrix: grown by block inversion, shrunk by the
/// Schur complement of the removed sample. Numbering follows KernelMatrix. The ridge λ keeps
/// duplicated points apart: every Schur complement is at least λ.
/// Memory: capacity² doubles, allocated in the constructor; no further allocation.
class KernelInverse {
 public:
  /// Requires capacity > 0, ridge > 0.
  KernelInverse(std::size_t capacity, double ridge);

  std::size_t size() const { return size_; }
  /// K⁻¹_ij.
  double operator()(std::size_t i, std::size_t j) const { return inverse_(index(i), index(j)); }

  /// δ = κ(x, x) − kᵀ(K + λI)⁻¹k of a point with the kernel row k: the squared distance of the
  /// point's image from the span of the dictionary, 0 for a dependent point. Cost O(n²).
  double independence(std::span<const double> row, double self);

  /// δ of sample i against the remaining samples, from the diagonal in O(1): 1/(K + λI)⁻¹_ii − λ.
  double independence(std::size_t i) const { return 1.0 / inverse_(index(i), index(i)) - ridge_; }

  void add(std::span<const double> row, double self);  ///< Requires a free place. Cost O(n²).
  void remove(std::size_t i);                          ///< Cost O(n²).

  /// A probe of the rounding errors so far: the largest |((K + λI) A − I) p| over fixed random
  /// signs p, A the present inverse; an entry has the size of a row's norm in (K + λI) A − I.
  /// `kernel` is the matrix K. Cost O(n²).
  double residual(const KernelMatrix& kernel);

  /// Makes the inverse afresh, sample by sample. Cost O(n³).
  void remake(const KernelMatrix& kernel);

  /// remake() when residual() exceeds 1e-7, and ten times the residual after the last remake() (for
  /// nearly singular kernel matrices). Returns true after a remake.
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
