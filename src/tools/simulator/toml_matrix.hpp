// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "file/toml.hpp"

namespace kelpie::simulator {

/// A list of `size` numbers.
template <int size>
Eigen::Matrix<double, size, 1> read_vector(const file::TomlNode& list) {
  Eigen::Matrix<double, size, 1> values;
  file::read_numbers(list, {values.data(), static_cast<std::size_t>(size)});
  return values;
}

/// Either `size` numbers, the diagonal, or `size` rows of `size` numbers.
template <int size>
Eigen::Matrix<double, size, size> read_square(const file::TomlNode& list) {
  const std::string n = std::to_string(size);
  const std::string kind = "an array of " + n + " numbers, the diagonal, or of " + n +
                           " such arrays, the rows of a matrix";
  const std::vector<file::TomlNode> rows = list.items(kind);
  if (rows.size() != static_cast<std::size_t>(size)) {
    list.refuse("has to be " + kind);
  }
  if (rows.front().type() != file::TomlNode::Type::list) {
    return read_vector<size>(list).asDiagonal();
  }
  Eigen::Matrix<double, size, size> values;
  for (int i = 0; i < size; ++i) {
    values.row(i) = read_vector<size>(rows[static_cast<std::size_t>(i)]);
  }
  return values;
}

}  // namespace kelpie::simulator
