// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/kernel/kernel_matrix.hpp"

namespace kelpie {

/// How far a β is from the optimum. With e_i = y_i − f(x_i) the optimum is characterised by
///
///     β_i = 0        −ε <= e_i <= ε
///     0 < β_i < C     e_i = ε             −C < β_i < 0    e_i = −ε
///     β_i = C         e_i >= ε             β_i = −C        e_i <= −ε
///
/// Every line bounds b from below (β_i may grow), from above (β_i may shrink) or both; the optimum
/// has max lower <= min upper, and b in between.
struct Kkt {
  double lower = 0.0;           ///< the largest lower bound of b
  double upper = 0.0;           ///< the smallest upper bound of b
  std::size_t most_upward = 0;  ///< the sample that sets `lower`

  /// The largest violation of the table with the best b there is; 0 at the optimum.
  double gap() const { return lower > upper ? 0.5 * (lower - upper) : 0.0; }
  double bias() const { return 0.5 * (lower + upper); }
};

/// The dual problem of ε-SVR (eq. 4) in β = α − α*, over samples that come and go:
///
///     minimise  ½ βᵀKβ − yᵀβ + ε‖β‖₁   subject to  |β_i| <= C,  Σβ_i = 0
///
/// Between calls Σβ = 0 and |β| <= C always hold, and the residuals without bias g = y − Kβ are up
/// to date. Samples are numbered as in KernelMatrix. Allocates in the constructor only.
class DualProblem {
 public:
  /// Requires capacity > 0, epsilon >= 0, c > 0, all finite.
  DualProblem(std::size_t capacity, double epsilon, double c, Storage storage = Storage::float64);

  std::size_t size() const { return kernel_.size(); }
  double epsilon() const { return epsilon_; }
  double c() const { return c_; }
  const KernelMatrix& kernel() const { return kernel_; }
  std::span<const double> targets() const { return {target_.data(), size()}; }
  std::span<const double> beta() const { return {beta_.data(), size()}; }
  /// g_i = y_i − Σ_j K_ij β_j; the residual of the table is e_i = g_i − b.
  std::span<const double> gradient() const { return {gradient_.data(), size()}; }
  /// The bounds that sample i sets for b: −∞ / +∞ where it sets none.
  double lower_bound(std::size_t i) const { return gradient_[i] + lower_offset_[i]; }
  /// The bound that sample i sets for b from above.
  double upper_bound(std::size_t i) const { return gradient_[i] + upper_offset_[i]; }
  std::span<const double> upper_offsets() const { return {upper_offset_.data(), size()}; }

  /// Second derivative of the objective along β_i += δ, β_j −= δ; never 0, so that a pair of equal
  /// points moves to its next kink or bound.
  double curvature(std::size_t i, std::size_t j) const {
    constexpr double kLeast = 1e-12;  // as LIBSVM
    const std::span<const double> self = kernel_.diagonal();
    return std::max(self[i] + self[j] - 2.0 * kernel_(i, j), kLeast);
  }

  /// Whether a weight is at ±C.
  bool bounded(std::size_t i) const { return beta_[i] >= c_ || beta_[i] <= -c_; }

  /// Adds a sample with β = 0. `row` is its kernel row against the samples so far. Cost O(n).
  void add(std::span<const double> row, double self, double target);

  /// Removes a sample, its weight handed over first. Cost O(n) per sample that takes a part.
  void remove(std::size_t i);

  void clear();  ///< Removes all samples.

  /// Takes the weight of a sample to 0 by handing it to the most similar samples with room for it,
  /// so that f changes least and Σβ = 0 stays; afterwards the problem wants solving again.
  void hand_over(std::size_t i);

  /// The two halves of a move, for a solver that knows how residuals change: it sees to it that
  /// Σβ = 0 and g = y − Kβ hold when it is done. Cost O(1).
  void set_beta(std::size_t i, double beta);
  void shift_gradient(std::size_t i, double change) { gradient_[i] += change; }  ///< g_i += change.

  /// Computes one residual afresh; returns by how much it was off. Cost O(n).
  double renew(std::size_t i);

  /// Other ε and C. Where a weight exceeds the new C, all are scaled down alike, which keeps Σβ =
  /// 0; afterwards the problem wants solving again. Cost O(n²).
  void reshape(double epsilon, double c);

  /// The table on the residuals at hand; an empty problem is at its optimum. Cost O(n).
  Kkt kkt() const;

  /// The same on residuals computed afresh from y, K and β. Cost O(n²). Allocates.
  Kkt kkt_afresh() const;

  /// The dual objective. Cost O(n).
  double objective() const;

  /// Minimises exactly along β_i += δ, β_j −= δ, δ >= 0 (piecewise quadratic: β may pass zero or
  /// stop at ±C). Requires lower_bound(i) > upper_bound(j). Returns δ. Cost O(n).
  double descend(std::size_t i, std::size_t j);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory of a problem in bytes, beside the object itself.
  static std::size_t bytes(std::size_t capacity, Storage storage);

 private:
  void shift(std::size_t i, std::size_t j, double delta);
  void refresh();

  double epsilon_;
  double c_;
  KernelMatrix kernel_;
  std::vector<double> target_;
  std::vector<double> beta_;
  std::vector<double> gradient_;
  std::vector<double> lower_offset_;
  std::vector<double> upper_offset_;
  std::size_t shifts_ = 0;  ///< since the residuals were last computed afresh
};

}  // namespace kelpie
