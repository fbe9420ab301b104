// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

// Numbers of this room as Eigen computes with them, column by column.
namespace kelpie {

inline Eigen::Map<const Eigen::MatrixXd> matrix_of(std::span<const double> numbers,
                                                   std::size_t rows) {
  return {numbers.data(), static_cast<Eigen::Index>(rows),
          static_cast<Eigen::Index>(numbers.size() / rows)};
}
inline Eigen::Map<Eigen::MatrixXd> matrix_of(std::span<double> numbers, std::size_t rows) {
  return {numbers.data(), static_cast<Eigen::Index>(rows),
          static_cast<Eigen::Index>(numbers.size() / rows)};
}

}  // namespace kelpie
