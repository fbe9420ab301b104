// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kelpie::mavlink {

/// MAVLink's checksum: CRC-16/MCRF4XX, taken on from `crc`.
inline std::uint16_t checksum(std::span<const std::byte> bytes, std::uint16_t crc = 0xFFFF) {
  constexpr unsigned kReversedPolynomial = 0x8408;
  for (const std::byte byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ static_cast<unsigned>(byte));
    for (int bit = 0; bit < 8; ++bit) {
      const unsigned carried = (crc & 1U) != 0 ? kReversedPolynomial : 0U;
      crc = static_cast<std::uint16_t>((crc >> 1U) ^ carried);
    }
  }
  return crc;
}

}  // namespace kelpie::mavlink
