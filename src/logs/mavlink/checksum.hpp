// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

/// The checksum of any stretch of a stream in a time that does not depend on the stretch's length.
/// The checksum is linear: with the states S after each byte, begun with 0, and Z_n the passage of
/// n zero bytes, the checksum of the bytes i to j is S_j ^ Z_{j-i}(S_i ^ 0xFFFF). A byte costs a
/// step.
class RunningChecksum {
 public:
  static constexpr std::size_t kMostBytes = 264;  ///< of a stretch: a frame's

  void add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
      states_.push_back(checksum(std::span(&byte, 1), states_.back()));
    }
  }

  /// Forgets the first bytes. Requires at most the bytes added.
  void drop(std::size_t bytes) {
    states_.erase(states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(bytes));
  }

  /// checksum() of `bytes` <= kMostBytes bytes from the place `first` on. Requires these bytes.
  std::uint16_t of(std::size_t first, std::size_t bytes) const {
    unsigned crc = states_[first + bytes];
    const unsigned before = states_[first] ^ 0xFFFFU;
    for (std::size_t bit = 0; bit < 16; ++bit) {
      crc ^= (before >> bit & 1U) != 0 ? kZeros[bytes][bit] : 0U;
    }
    return static_cast<std::uint16_t>(crc);
  }

 private:
  using Passage = std::array<std::uint16_t, 16>;  // of each bit through zeros

  static constexpr std::array<Passage, kMostBytes + 1> kZeros = [] {
    std::array<Passage, kMostBytes + 1> zeros{};
    for (std::size_t bit = 0; bit < 16; ++bit) {
      unsigned crc = 1U << bit;
      for (Passage& passage : zeros) {
        passage.at(bit) = static_cast<std::uint16_t>(crc);
        crc = crc >> 8U ^ kChecksumSteps[crc & 0xFFU];
      }
    }
    return zeros;
  }();

  std::vector<std::uint16_t> states_{0};
};

}  // namespace kelpie::mavlink
