// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "svr/kernel_matrix.hpp"

namespace kelpie {

/// The violation of the optimality conditions. With e_i = y_i − f(x_i) the optimum satisfies
///
///     β_i = 0        −ε <= e_i <= ε
///     0 < β_i < C     e_i = ε             −C < β_i < 0    e_i = −ε
///     β_i = C         e_i >= ε             β_i = −C        e_i <= −ε
///
/// Every line bounds b from below (β_i may grow), from above (β_i may shrink) or from both sides.
/// The optimum has max lower <= b <= min upper.
struct Kkt {
  double lower = 0.0;           ///< the largest lower bound of b
  double upper = 0.0;           ///< the smallest upper bound of b
  std::size_t most_upward = 0;  ///< the sample of `lower`

  /// The largest violation of the table with the best b; 0 at the optimum.
  double gap() const { return lower > upper ? 0.5 * (lower - upper) : 0.0; }
  double bias() const { return 0.5 * (lower + upper); }
};

/// The loss of a residual e: C max(0, |e| − ε).
struct Loss {
  double epsilon = 0.0;  ///< ε
  double c = 0.0;        ///< C
};

/// The dual problem of ε-SVR (eq. 4) in β = α − α*, over a changing set of samples:
///
///     minimise  ½ βᵀKβ − yᵀβ + ε‖β‖₁   subject to  |β_i| <= C,  Σβ_i = 0
///
/// Between calls Σβ = 0 and |β| <= C hold, and the residuals without bias g = y − Kβ are up
/// to date. Samples are numbered as in KernelMatrix. Allocates in the constructor only.
class DualProblem {
 public:
  /// Requires capacity > 0, epsilon >= 0, c > 0, all finite.
  DualProblem(std::size_t capacity, double epsilon, double c, Storage storage = Storage::float64);

  std::size_t size() const { return kernel_.size(); }
  const Loss& loss() const { return loss_; }
  const KernelMatrix& kernel() const { return kernel_; }
  std::span<const double> targets() const { return {target_.data(), size()}; }
  std::span<const double> beta() const { return {beta_.data(), size()}; }
  /// g_i = y_i − Σ_j K_ij β_j; the residual of the table is e_i = g_i − b.
  std::span<const double> gradient() const { return {gradient_.data(), size()}; }
  /// The bound of sample i on b from below; −∞ without a bound.
  double lower_bound(std::size_t i) const { return gradient_[i] + lower_offset_[i]; }
  /// The bound of sample i on b from above; +∞ without a bound.
  double upper_bound(std::size_t i) const { return gradient_[i] + upper_offset_[i]; }

  /// Adds a sample with β = 0. `row` is its kernel row against the samples so far. Cost O(n).
  void add(std::span<const double> row, double self, double target);

  /// Removes a sample after hand_over(). Cost O(n) per sample that receives weight.
  void remove(std::size_t i);

  void clear();  ///< Removes all samples.

  /// Moves the weight of a sample to the most similar samples below their bounds: f changes least
  /// and Σβ = 0 is kept. The problem has to be solved afterwards.
  void hand_over(std::size_t i);

  /// Sets one weight, for a solver that updates the residuals by set_gradient(). The solver
  /// restores Σβ = 0 and g = y − Kβ. Cost O(1).
  void set_beta(std::size_t i, double beta);
  void set_gradient(std::size_t i, double residual) { gradient_[i] = residual; }  ///< Sets g_i.

  /// The table with the stored residuals; an empty problem is optimal. Cost O(n).
  Kkt kkt() const;

  /// Minimises exactly along β_i += δ, β_j −= δ, δ >= 0 (piecewise quadratic: β may pass zero or
  /// stop at ±C). Requires lower_bound(i) > upper_bound(j). Returns δ. Cost O(n).
  double descend(std::size_t i, std::size_t j);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory of a problem in bytes, beside the object itself.
  static std::size_t bytes(std::size_t capacity, Storage storage);

 private:
  void shift(std::size_t i, std::size_t j, double delta);
  void refresh();

  Loss loss_;
  KernelMatrix kernel_;
  std::vector<double> target_;
  std::vector<double> beta_;
  std::vector<double> gradient_;
  std::vector<double> lower_offset_;
  std::vector<double> upper_offset_;
  std::size_t shifts_ = 0;  ///< since the residuals were last recomputed
};

/// Recomputes one residual; returns the absolute correction. Cost O(n).
double renew(DualProblem& problem, std::size_t i);

/// Whether a weight is at ±C.
inline bool at_bound(const DualProblem& problem, std::size_t i) {
  return std::abs(problem.beta()[i]) >= problem.loss().c;
}

/// Second derivative of the objective along β_i += δ, β_j −= δ. Always positive: a pair of equal
/// samples then moves to the next kink or bound.
inline double curvature(const KernelMatrix& kernel, std::size_t i, std::size_t j) {
  constexpr double kLeast = 1e-12;  // as LIBSVM
  const std::span<const double> self = kernel.diagonal();
  return std::max(self[i] + self[j] - 2.0 * kernel(i, j), kLeast);
}

/// The table with residuals recomputed from y, K and β. Cost O(n²). Allocates.
Kkt kkt_afresh(DualProblem problem);

/// The dual objective. Cost O(n).
double objective(const DualProblem& problem);

}  // namespace kelpie
