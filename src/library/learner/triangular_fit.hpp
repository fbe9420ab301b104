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
/// Stored as the triangular factor of [φ y] (Givens rotations): RᵀR = Σ φφᵀ, Rθ = z. The covariance
/// P = (RᵀR)⁻¹ is therefore symmetric and positive definite by construction, and θ has the accuracy
/// of a QR factorisation. The prior of a coefficient is relative to its term's second moment q_k: a
/// pseudo-row states θ_k = 0 with the weight of ρ rows of size √q_k, repeated when q_k has doubled.
/// The coefficient of a term without excitation is 0. Terms need no scaling. Allocates in the
/// constructor only. Several targets of the same rows share R: each has its own z and θ.
class TriangularFit {
 public:
  /// `prior` ρ: prior information of a coefficient, in rows of its term's usual size.
  TriangularFit(std::size_t terms, double prior, std::size_t targets = 1);

  std::size_t terms() const { return moment_.size(); }
  std::size_t targets() const { return theta_.size() / terms(); }
  std::int64_t rows() const { return rows_; }
  /// θ of all targets, one after the other, unit of y per term's.
  std::span<const double> theta() const { return theta_; }
  std::span<const double> theta(std::size_t target) const {
    return theta().subspan(target * terms(), terms());
  }
  std::span<const double> moments() const { return moment_; }  ///< q_k

  /// Requires finite values whose squares are finite, and a y per target. Cost O(m²) for m terms.
  void add(std::span<const double> phi, std::span<const double> y);
  void add(std::span<const double> phi, double y) { add(phi, std::span(&y, 1)); }

  /// Multiplies the information of column k by keep_k²; θ does not change. Requires a number in
  /// (0, 1] per term. Cost O(m²).
  void forget(std::span<const double> keep);

  /// Limits the weight of the rows to `rows` rows; θ and the correlations of coefficients do not
  /// change. Requires rows > 0. Cost O(m²).
  void limit_rows(std::int64_t rows);

  /// Adds θ_k = 0 with the weight of `rows` rows of the term's usual size. Requires rows >= 0. Cost
  /// O(m²).
  void hold(std::size_t term, double rows);

  /// Sets θ of all targets; the information about the coefficients does not change. Requires a
  /// value per term, 0 for a term without excitation. Cost O(m²).
  void set_theta(std::span<const double> theta);

  /// P_kk in the units of the terms; infinite for a term without excitation. Cost O(m²).
  double variance(std::size_t term) const;

  /// φᵀPφ, the variance of the value θᵀφ per unit of the noise variance; infinite where φ has a
  /// term without excitation. Requires a value per term. Cost O(m²).
  double leverage(std::span<const double> phi) const;

  /// Terms have other units: φ_k becomes factors[k] φ_k. Requires a factor > 0 per term. Cost
  /// O(m²).
  void rescale(std::span<const double> factors);

  void clear();  ///< Forgets the rows.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  void add_priors(std::span<const double> phi);
  void absorb();
  void solve();
  /// |R⁻ᵀ x|² of the vector x in scratch_, which is 0 before `first`; `unexcited` counts for an
  /// entry of a term without excitation.
  double forward_square(std::size_t first, double unexcited) const;

  double least_;
  std::vector<double> factor_;  ///< [R z …], upper triangular, row-major
  std::vector<double> row_;     ///< [φ y …] on its way into the factor
  std::vector<double> theta_;
  std::vector<double> moment_;
  std::vector<double> prior_;  ///< information given to each term as prior
  mutable std::vector<double> scratch_;
  std::int64_t rows_ = 0;
};

}  // namespace kelpie
