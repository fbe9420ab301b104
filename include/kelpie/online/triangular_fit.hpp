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

  /// Lets what is known of column k count keep_k² times as much as before; θ stays.
  /// Requires a number in (0, 1] per term. Cost O(m²).
  void forget(std::span<const double> keep);

  /// Lets all rows so far count as `rows` where there are more; θ stays, and all that is known of
  /// coefficients together. Requires rows > 0. Cost O(m²).
  void limit_rows(std::int64_t rows);

  /// Says θ_k = 0 with the weight of so many rows of the term's usual size. Requires rows >= 0.
  /// Cost O(m²).
  void hold(std::size_t term, double rows);

  /// As if the rows had said this θ; what is known of each coefficient stays. Requires a value per
  /// term; it is 0 for a term never excited. Cost O(m²).
  void set_theta(std::span<const double> theta);

  /// P_kk in the terms' units; infinite for a term never excited. Cost O(m²).
  double variance(std::size_t term) const;

  void clear();  ///< Forgets all rows.

  /// Forgets all rows, and expects this θ: as if known of each coefficient alone, with as much
  /// information 1/P_kk. Where that is 0 nothing is known, and θ_k is 0. Requires a value per term
  /// of each, information >= 0. Cost O(m²), without arithmetic.
  void set_prior(std::span<const double> theta, std::span<const double> information);

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
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
