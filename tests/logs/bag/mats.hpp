// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kelpie::testing {

/// A .mat file of version 5 with these columns of numbers, not compressed.
inline std::string mat_file(
    const std::vector<std::pair<std::string, std::vector<double>>>& columns) {
  const auto raw = [](auto value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(value)>>(value);
    return std::string(bytes.data(), bytes.size());
  };
  const auto element = [&](std::uint32_t kind, std::string data) {
    const std::string tag = raw(kind) + raw(static_cast<std::uint32_t>(data.size()));
    data.resize((data.size() + 7) / 8 * 8, '\0');
    return tag + data;
  };
  std::string file = "MATLAB 5.0 MAT-file";
  file.resize(124, ' ');
  file += std::string("\0\1IM", 4);
  for (const auto& [name, values] : columns) {
    std::string numbers;
    for (const double value : values) {
      numbers += raw(value);
    }
    const auto rows = static_cast<std::uint32_t>(values.size());
    file += element(14, element(6, raw(std::uint32_t{6}) + raw(std::uint32_t{0})) +  // doubles
                            element(5, raw(rows) + raw(std::uint32_t{1})) + element(1, name) +
                            element(9, numbers));
  }
  return file;
}

}  // namespace kelpie::testing
