// SPDX-License-Identifier: Apache-2.0
#include "file/crc32c.hpp"

#include <array>
#include <cstddef>

namespace kelpie::file {
namespace {

constexpr std::uint32_t kPolynomial = 0x82F63B78;  // Castagnoli's, lowest bit first
constexpr std::size_t kStep = 8;                   // bytes taken at a time

using Tables = std::array<std::array<std::uint32_t, 256>, kStep>;

// tables[k][b]: what byte b adds when k more bytes follow it.
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) {
      rest = (rest >> 1U) ^ ((rest & 1U) != 0 ? kPolynomial : 0U);
    }
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < kStep; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t rest = tables[k - 1][byte];
      tables[k][byte] = (rest >> 8U) ^ tables[0][rest & 0xFFU];
    }
  }
  return tables;
}

constexpr Tables kTables = make_tables();

}  // namespace

std::uint32_t crc32c(std::string_view bytes, std::uint32_t before) {
  const auto byte_at = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i]));
  };
  std::uint32_t rest = ~before;
  std::size_t i = 0;
  for (; i + kStep <= bytes.size(); i += kStep) {
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < kStep; ++k) {
      const auto shift = static_cast<unsigned>(8 * k);
      const std::uint32_t old = k < sizeof rest ? (rest >> shift) & 0xFFU : 0U;
      next ^= kTables[kStep - 1 - k][byte_at(i + k) ^ old];
    }
    rest = next;
  }
  for (; i < bytes.size(); ++i) {
    rest = (rest >> 8U) ^ kTables[0][(rest ^ byte_at(i)) & 0xFFU];
  }
  return ~rest;
}

}  // namespace kelpie::file
