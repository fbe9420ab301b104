// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/eigen.hpp"
#include "kelpie/core/archive.hpp"

namespace kelpie {

/// Sums of a linear least-squares problem Y ≈ Φ Θ over rows (φ, y):
///   A = Σ φφᵀ (terms × terms),   B = Σ φyᵀ (terms × targets),   C = Σ yyᵀ (targets × targets).
/// The sums of two sets of rows add up to the sums of both sets. Allocates at construction, unless
/// a function says otherwise.
///
/// For batches of rows: diagnosis, identification, the alignment of commands. The on-line learners
/// update a triangular factor (TriangularFit) with every row instead, which is another algorithm.
class NormalEquations {
 public:
  NormalEquations() = default;  ///< No terms and no targets.
  NormalEquations(std::size_t terms, std::size_t targets);

  /// Weighted sums; a row of `design` and of `targets` per row of data. Allocates.
  static NormalEquations of_weighted(const Eigen::MatrixXd& design, const Eigen::MatrixXd& targets,
                                     const Eigen::VectorXd& weights);

  void add(std::span<const double> phi, std::span<const double> y);  ///< One row.
  /// Several rows, a column of `phi` and of `y` per row. Faster than row by row. Allocates.
  void add_block(const Eigen::Ref<const Eigen::MatrixXd>& phi,
                 const Eigen::Ref<const Eigen::MatrixXd>& y);
  void add(const NormalEquations& other);       ///< Requires the same sizes.
  void subtract(const NormalEquations& other);  ///< Removes rows that were added.
  void scale(double factor);                    ///< Multiplies the weight of all rows (forgetting).
  void clear();                                 ///< Removes all rows.

  /// The sums for targets y + Δᵀφ, with Δ (terms × targets) column by column.
  void shift(std::span<const double> delta);

  double rows() const { return rows_; }  ///< Their total weight.
  std::size_t terms() const { return terms_; }
  std::size_t targets() const { return targets_; }
  Eigen::Map<const Eigen::MatrixXd> gram() const { return columns_of(a_, terms_); }       ///< A
  Eigen::Map<const Eigen::MatrixXd> moments() const { return columns_of(b_, terms_); }    ///< B
  Eigen::Map<const Eigen::MatrixXd> squares() const { return columns_of(c_, targets_); }  ///< C

  /// Θ = (A + ridge · diag A)⁻¹ B. Requires room for terms² numbers in `scratch` and for terms ×
  /// targets in `theta`. Allocates nothing. Cost: O(terms³).
  void solve(double ridge, std::span<double> scratch, std::span<double> theta) const;
  /// Θ = (A + diag(prior))⁻¹ B. Allocates. Cost: O(terms³).
  Eigen::MatrixXd solve(const Eigen::VectorXd& prior) const;

  /// Σ (y_j − θ_jᵀφ)² of every target j, for coefficients of any origin. Allocates.
  Eigen::ArrayXd squared_errors(const Eigen::MatrixXd& theta) const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t terms_ = 0, targets_ = 0;
  double rows_ = 0.0;
  std::vector<double> a_, b_, c_;
};

/// matrix += diag(ridge · diagonal + 1e-300): a factorisation succeeds where rows have no
/// information.
template <typename Matrix>
void add_relative_ridge(Matrix&& matrix, double ridge) {
  for (double& value : matrix.diagonal()) {
    value += ridge * value + 1e-300;
  }
}

/// A⁻¹, the covariance of coefficients per unit of noise, for columns of very different size. A
/// column of zeros has the variance of the smallest positive number. Allocates.
Eigen::MatrixXd equilibrated_inverse(const Eigen::MatrixXd& gram);

}  // namespace kelpie
