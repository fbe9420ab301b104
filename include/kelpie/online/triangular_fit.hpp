// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// Least squares over a stream of rows, in square-root form:
///
///     θ = argmin Σ_i (y_i − θᵀφ_i)² + prior
///
/// Kept as the triangular factor of [φ y] (Givens rotations): RᵀR = Σ φφᵀ, Rθ = z. So the
/// covariance P = (RᵀR)⁻¹ is symmetric and positive definite by construction, and θ has the
/// accuracy of a QR factorisation. Coefficients are told apart by their terms' second moments q_k:
/// a pseudo-row says θ_k = 0 with the weight of ρ rows of size √q_k, and again when q_k has
/// doubled. Until a term is excited for the first time its coefficient is 0. So no term needs to be
/// scaled. Allocates in the constructor only.
class TriangularFit {
 public:
  /// `prior` ρ: the least that is known of a coefficient, in rows of its term's usual size.
  TriangularFit(std::size_t terms, double prior);

  std::size_t terms() const { return theta_.size(); }
  std::int64_t rows() const { return rows_; }
  std::span<const double> theta() const { return theta_; }     ///< θ, unit of y per term's
  std::span<const double> moments() const { return moment_; }  ///< q_k

  /// Requires finite values whose squares are finite. Cost O(m²) for m terms.
  void add(std::span<const double> phi, double y);

  /// The same of y = 0 before any other row: θ is 0 and stays it. Cost O(m) for every value of φ
  /// that isn't 0.
  void add_zero(std::span<const double> phi);

  /// Lets what is known of column k count keep_k² times as much as before; θ stays.
  /// Requires a number in (0, 1] per term. Cost O(m²).
  void forget(std::span<const double> keep);

  /// As if the rows had said this θ; what is known of each coefficient stays. Requires a value per
  /// term; it is 0 for a term never excited. Cost O(m²).
  void settle(std::span<const double> theta);

  /// P_kk in the terms' units; infinite for a term never excited. Cost O(m²).
  double variance(std::size_t term) const;

  void clear();  ///< Forgets all rows.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  void take(std::span<const double> phi, double y);
  void add_priors(std::span<const double> phi);
  void absorb();
  void solve();

  double least_;
  std::vector<double> factor_;  ///< [R z], upper triangular, row-major
  std::vector<double> row_;     ///< [φ y] on its way into the factor
  std::vector<double> theta_;
  std::vector<double> moment_;
  std::vector<double> prior_;  ///< information given to each term so far as prior
  mutable std::vector<double> scratch_;
  std::int64_t rows_ = 0;
};

}  // namespace kelpie
