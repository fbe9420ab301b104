// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"

namespace kelpie {

/// A lower triangular or symmetric matrix that grows by rows at its end; row i holds the columns 0
/// to i side by side. Allocates in the constructor only.
class Triangle {
 public:
  explicit Triangle(std::size_t capacity) { values_.reserve(capacity * (capacity + 1) / 2); }

  std::size_t size() const { return size_; }
  std::span<double> row(std::size_t i) { return {values_.data() + i * (i + 1) / 2, i + 1}; }
  std::span<const double> row(std::size_t i) const {
    return {values_.data() + i * (i + 1) / 2, i + 1};
  }
  double diagonal(std::size_t i) const { return values_[i * (i + 3) / 2]; }

  /// New rows are zero. Requires size <= capacity.
  void resize(std::size_t size) {
    size_ = size;
    values_.resize(size * (size + 1) / 2);
  }

  void scale(double factor);  ///< All numbers by a factor.

  /// The symmetric matrix += weight · x xᵀ. Requires a number per row. Cost O(size²).
  void add_square(double weight, std::span<const double> x);

  /// y = M x for the symmetric matrix, by the leading block of x.size() rows. Cost O(x.size()²).
  void multiply(std::span<const double> x, std::span<double> y) const;

  /// Row i of Cholesky's factor in the place of row i of a positive definite matrix, whose rows
  /// before i are factorised. False, and the row is spoilt, where the matrix is not positive
  /// definite. Cost O(i²).
  bool factorise_row(std::size_t i);

  /// L⁻¹ x in the place of x, by a factor. Requires x.size() <= size(). Cost O(x.size()²).
  void solve_lower(std::span<double> x) const;
  /// L⁻ᵀ x in the place of x, by the leading block of x.size() rows. Likewise.
  void solve_upper(std::span<double> x) const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t size_ = 0;
  RoomyVector<double> values_;
};

}  // namespace kelpie
