// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace kelpie {

// The library computes with Eigen, but public headers show no type of Eigen: layout and memory
// management of Eigen's types follow from the compiler flags of the user (-march,
// EIGEN_MAX_ALIGN_BYTES), which may differ from the flags of the library.

/// A matrix in column-major order.
class Matrix {
 public:
  Matrix() = default;

  /// A matrix of zeros. Allocates.
  Matrix(std::size_t rows, std::size_t columns) : rows_(rows), values_(rows * columns) {}

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return rows_ > 0 ? values_.size() / rows_ : 0; }

  /// Requires row < rows() and column < columns().
  double& operator()(std::size_t row, std::size_t column) { return values_[column * rows_ + row]; }
  /// As above.
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
  std::span<const double> values() const { return values_; }  ///< As above.

 private:
  std::size_t rows_ = 0;
  std::vector<double> values_;
};

/// Up to `most` numbers on the stack. Predictions are computed in such vectors, so that predictions
/// neither allocate nor share scratch memory between threads.
template <std::size_t most>
class ShortVector {
 public:
  explicit ShortVector(std::size_t size = 0) : size_(size) {}  ///< Values are not set.

  std::size_t size() const { return size_; }
  double* data() { return values_.data(); }                      ///< As of std::vector.
  const double* data() const { return values_.data(); }          ///< As above.
  double* begin() { return data(); }                             ///< The first.
  double* end() { return data() + size_; }                       ///< Behind the last.
  const double* begin() const { return data(); }                 ///< The first.
  const double* end() const { return data() + size_; }           ///< Behind the last.
  double& operator[](std::size_t i) { return values_[i]; }       ///< Requires i < size().
  double operator[](std::size_t i) const { return values_[i]; }  ///< As above.

 private:
  std::size_t size_;
  alignas(16) std::array<double, most> values_;  // NOLINT(*-member-init): set by the user
};

/// The values of a vector.
template <typename Vector>
std::span<const double> as_span(const Vector& vector) {
  return {vector.data(), vector.size()};
}

}  // namespace kelpie
