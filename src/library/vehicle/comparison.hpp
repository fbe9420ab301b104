// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/normal_equations.hpp"
#include "vehicle/explanations.hpp"

namespace kelpie {

/// Least-squares coefficients of the equations of motion and the precision of the residuals.
class ReferenceFit {
 public:
  ReferenceFit(std::size_t terms, std::size_t axes);  ///< Allocates; all coefficients are 0.

  void fit(const NormalEquations& sums);  ///< Θ = A⁻¹B. Requires a row or more.

  std::span<const double> theta() const { return theta_; }          ///< terms × axes
  std::span<const double> precision() const { return precision_; }  ///< Σ⁻¹ of the residuals

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::vector<double> theta_, precision_, scratch_;
};

/// Agreement of rows with a change of the coefficients along some columns.
struct Agreement {
  double evidence = 0.0;                     ///< log likelihood ratio against no change
  std::array<double, kMostColumns> size{};   ///< along each column
  std::array<double, kMostColumns> error{};  ///< standard errors of the sizes
};

/// Compares the rows of a stretch with a reference. With g = Σ φ(y − Θᵀφ)ᵀ over the stretch and
/// information A_a, A_b of stretch and reference, a change Δ of the coefficients has the
///   log likelihood ratio  tr(Σ⁻¹ (Gᵀ Δ − ½ Δᵀ P Δ)),
///   P = A_b (A_a + A_b)⁻¹ A_a,   G = A_b (A_a + A_b)⁻¹ g,
/// with the uncertainty of the reference integrated out. Along the directions D_c of the
/// explanations the ratio is a quadratic function of the sizes. Allocates at construction only.
class Comparison {
 public:
  Comparison(std::size_t terms, std::size_t axes, std::size_t columns);

  /// `directions`: Explanations::directions() at the coefficients of the reference.
  /// Cost: O(terms³).
  void compare(const NormalEquations& reference, const ReferenceFit& fit,
               const NormalEquations& stretch, std::span<const double> directions);

  /// Agreement of the columns in both lists: each column once, at most kMostColumns in total.
  Agreement of(std::span<const std::size_t> columns, std::span<const std::size_t> more = {}) const;

  /// Agreement of a change ΔΘ = `delta` (evidence), and of a further step along `tangent` (size and
  /// error); both are terms × axes.
  Agreement beyond(std::span<const double> delta, std::span<const double> tangent);

  double whole() const { return whole_; }  ///< Evidence of an unrestricted refit.

 private:
  double refit_evidence(const NormalEquations& reference, const NormalEquations& stretch,
                        std::span<const double> precision_numbers);
  void project(std::span<const double> directions);
  double slope_along(std::span<const double> direction) const;
  void weigh(std::span<const double> direction);

  std::size_t terms_;
  std::vector<double> joint_, narrow_, score_, discounted_, information_, along_, precision_;
  std::vector<double> gram_, slope_;
  double whole_ = 0.0;
};

}  // namespace kelpie
