// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// What least squares need to know of rows (φ, y): A = Σ φφᵀ, B = Σ φyᵀ, C = Σ yyᵀ and how many.
/// Sums of two stretches of rows are those of both together. Allocates at construction only.
class Sums {
 public:
  /// Of so many terms and axes.
  Sums(std::size_t terms, std::size_t axes);

  void add(std::span<const double> phi, std::span<const double> y);  ///< One row.
  void add(const Sums& other);                                       ///< Those of the same size.
  void scale(double factor);                                         ///< Each row counts that much.
  void clear() { scale(0.0); }                                       ///< No rows.

  /// As if all y had been φᵀΔ greater: Δ of terms × axes, column by column.
  void shift(std::span<const double> delta);

  double rows() const { return rows_; }                ///< As many as count.
  std::size_t terms() const { return terms_; }         ///< Of φ.
  std::size_t axes() const { return axes_; }           ///< Of y.
  const std::vector<double>& a() const { return a_; }  ///< terms × terms, column by column
  const std::vector<double>& b() const { return b_; }  ///< terms × axes
  const std::vector<double>& c() const { return c_; }  ///< axes × axes

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t terms_, axes_;
  double rows_ = 0.0;
  std::vector<double> a_, b_, c_;
};

}  // namespace kelpie
