// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kelpie::file {

/// The CRC-32 of zlib (and of MCAP) over `bytes`, continued from the CRC `before`.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace kelpie::file
