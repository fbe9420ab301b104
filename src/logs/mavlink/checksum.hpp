// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kelpie::mavlink {

/// Table of eight checksum steps per byte.
constexpr std::array<std::uint16_t, 256> kChecksumSteps = [] {
  constexpr unsigned kReversedPolynomial = 0x8408;
  std::array<std::uint16_t, 256> steps{};
  for (unsigned byte = 0; byte < steps.size(); ++byte) {
    unsigned crc = byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? kReversedPolynomial : 0U);
    }
    steps.at(byte) = static_cast<std::uint16_t>(crc);
  }
  return steps;
}();

/// MAVLink's checksum: CRC-16/MCRF4XX, taken on from `crc`.
inline std::uint16_t checksum(std::span<const std::byte> bytes, std::uint16_t crc = 0xFFFF) {
  for (const std::byte byte : bytes) {
    const std::uint16_t step = kChecksumSteps[(crc ^ static_cast<unsigned>(byte)) & 0xFFU];
    crc = static_cast<std::uint16_t>(crc >> 8U ^ step);
  }
  return crc;
}

}  // namespace kelpie::mavlink
