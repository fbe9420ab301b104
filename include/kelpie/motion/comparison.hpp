// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/motion/explanations.hpp"
#include "kelpie/motion/sums.hpp"

namespace kelpie {

/// Coefficients of the equations of motion from rows, with what they leave.
class ReferenceFit {
 public:
  ReferenceFit(std::size_t terms, std::size_t axes);  ///< Allocates; all coefficients are 0.

  void fit(const Sums& sums);  ///< Least squares, Θ = A⁻¹B. Requires a row or more.

  std::span<const double> theta() const { return theta_; }          ///< terms × axes
  std::span<const double> precision() const { return precision_; }  ///< Σ⁻¹ of what is left

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::vector<double> theta_, precision_, scratch_;
};

/// How well a change along some columns agrees with rows.
struct Agreement {
  double evidence = 0.0;                     ///< log likelihood ratio against no change
  std::array<double, kMostColumns> size{};   ///< along each column
  std::array<double, kMostColumns> error{};  ///< their standard errors
};

/// The rows of a stretch against a reference. With g = Σ φ(y − Θᵀφ)ᵀ over the stretch and
/// information A_a, A_b of stretch and reference, the coefficients have changed by Δ with
///   log likelihood ratio  tr(Σ⁻¹ (Gᵀ Δ − ½ Δᵀ P Δ)),
///   P = A_b (A_a + A_b)⁻¹ A_a,   G = A_b (A_a + A_b)⁻¹ g
/// in which the reference's own uncertainty has been integrated out. Along the directions D_c of
/// the explanations this is a quadratic of their sizes alone. Allocates at construction only.
class Comparison {
 public:
  Comparison(std::size_t terms, std::size_t axes, std::size_t columns);  ///< Nothing compared yet.

  /// `directions` as Explanations::directions gives them at the reference's coefficients.
  /// Cost: O(terms³).
  void compare(const Sums& reference, const ReferenceFit& fit, const Sums& stretch,
               std::span<const double> directions);

  /// Of some columns, then some more; none twice, no more than kMostColumns in all.
  Agreement of(std::span<const std::size_t> columns, std::span<const std::size_t> more = {}) const;

  /// Of a change ΔΘ = `delta` and a further step along `tangent`, both terms × axes: the evidence
  /// of the change as it is, and the step's size and error.
  Agreement beyond(std::span<const double> delta, std::span<const double> tangent);

  double whole() const { return whole_; }  ///< The same of a refit without any restriction.

 private:
  double slope_along(std::span<const double> direction) const;
  void weigh(std::span<const double> direction);

  std::size_t terms_;
  std::vector<double> joint_, narrow_, score_, discounted_, information_, along_, precision_;
  std::vector<double> gram_, slope_;
  double whole_ = 0.0;
};

}  // namespace kelpie
