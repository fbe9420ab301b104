// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace kelpie {

// Eigen computes inside of the library, but none of its types stands in a public header: their
// layout, and how their memory is freed, follow from the flags of whoever includes them (-march,
// EIGEN_MAX_ALIGN_BYTES), which needn't be those the library was built with.

/// A matrix with memory of its own, a column after the other.
class Matrix {
 public:
  Matrix() = default;

  /// So many rows and columns of zeros. Allocates.
  Matrix(std::size_t rows, std::size_t columns) : rows_(rows), values_(rows * columns) {}

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return rows_ > 0 ? values_.size() / rows_ : 0; }

  /// Requires a row and a column that are there.
  double& operator()(std::size_t row, std::size_t column) { return values_[column * rows_ + row]; }
  /// The same.
  double operator()(std::size_t row, std::size_t column) const {
    return values_[column * rows_ + row];
  }

  /// A copy of a row. Allocates.
  std::vector<double> row(std::size_t row) const {
    std::vector<double> values(columns());
    for (std::size_t column = 0; column < values.size(); ++column) {
      values[column] = (*this)(row, column);
    }
    return values;
  }

  /// All values, column-major.
  std::span<double> values() { return values_; }
  std::span<const double> values() const { return values_; }  ///< The same.

 private:
  std::size_t rows_ = 0;
  std::vector<double> values_;
};

/// Up to `most` numbers on the stack: what predictions are computed in, so that they neither
/// allocate nor share scratch memory between threads.
template <std::size_t most>
class ShortVector {
 public:
  explicit ShortVector(std::size_t size = 0) : size_(size) {}  ///< Values aren't set yet.

  std::size_t size() const { return size_; }
  double* data() { return values_.data(); }              ///< As std::vector has it, like the rest.
  const double* data() const { return values_.data(); }  ///< The same.
  double* begin() { return data(); }                     ///< The first.
  double* end() { return data() + size_; }               ///< Behind the last.
  const double* begin() const { return data(); }         ///< The first.
  const double* end() const { return data() + size_; }   ///< Behind the last.
  double& operator[](std::size_t i) { return values_[i]; }       ///< Requires i < size().
  double operator[](std::size_t i) const { return values_[i]; }  ///< The same.

 private:
  std::size_t size_;
  alignas(16) std::array<double, most> values_;  // NOLINT(*-member-init): set by who fills it
};

/// What a vector holds.
template <typename Vector>
std::span<const double> as_span(const Vector& vector) {
  return {vector.data(), vector.size()};
}

}  // namespace kelpie
