// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kelpie::testing {

/// The bytes of a number as stored.
template <typename Number>
std::string mat_raw(Number value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(value)>>(value);
  return std::string(bytes.data(), bytes.size());
}

/// An element of a .mat file: tag, data, padding.
inline std::string mat_element(std::uint32_t kind, std::string data) {
  const std::string tag = mat_raw(kind) + mat_raw(static_cast<std::uint32_t>(data.size()));
  data.resize((data.size() + 7) / 8 * 8, '\0');
  return tag + data;
}

/// The head of a .mat file of version 5.
inline std::string mat_head() {
  std::string head = "MATLAB 5.0 MAT-file";
  head.resize(124, ' ');
  return head + std::string("\0\1IM", 4);
}

/// A .mat file of version 5 with these columns of numbers, not compressed.
inline std::string mat_file(
    const std::vector<std::pair<std::string, std::vector<double>>>& columns) {
  std::string file = mat_head();
  for (const auto& [name, values] : columns) {
    std::string numbers;
    for (const double value : values) {
      numbers += mat_raw(value);
    }
    const auto rows = static_cast<std::uint32_t>(values.size());
    file += mat_element(
        14, mat_element(6, mat_raw(std::uint32_t{6}) + mat_raw(std::uint32_t{0})) +  // doubles
                mat_element(5, mat_raw(rows) + mat_raw(std::uint32_t{1})) + mat_element(1, name) +
                mat_element(9, numbers));
  }
  return file;
}

}  // namespace kelpie::testing
