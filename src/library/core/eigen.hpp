// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <type_traits>

#include "kelpie/core/matrix.hpp"

// Numbers of public types as Eigen computes with them. For sources only: core/matrix.hpp says why.
namespace kelpie {

/// The numbers of a span, a std::vector or a ShortVector.
template <typename Numbers>
auto as_vector(Numbers&& numbers) {
  using Number = std::remove_pointer_t<decltype(numbers.data())>;
  using Vector =
      std::conditional_t<std::is_const_v<Number>, const Eigen::VectorXd, Eigen::VectorXd>;
  return Eigen::Map<Vector>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

inline Eigen::Map<Eigen::MatrixXd> as_matrix(Matrix& matrix) {
  return {matrix.values().data(), static_cast<Eigen::Index>(matrix.rows()),
          static_cast<Eigen::Index>(matrix.columns())};
}
inline Eigen::Map<const Eigen::MatrixXd> as_matrix(const Matrix& matrix) {
  return {matrix.values().data(), static_cast<Eigen::Index>(matrix.rows()),
          static_cast<Eigen::Index>(matrix.columns())};
}

/// The numbers of a matrix of so many rows, column by column.
inline Eigen::Map<Eigen::MatrixXd> columns_of(std::span<double> numbers, std::size_t rows) {
  return {numbers.data(), static_cast<Eigen::Index>(rows),
          static_cast<Eigen::Index>(numbers.size() / rows)};
}
inline Eigen::Map<const Eigen::MatrixXd> columns_of(std::span<const double> numbers,
                                                    std::size_t rows) {
  return {numbers.data(), static_cast<Eigen::Index>(rows),
          static_cast<Eigen::Index>(numbers.size() / rows)};
}

}  // namespace kelpie
