// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kelpie::file {

/// The CRC-32 of zlib (and of MCAP) over `bytes`, or over what `before` is the CRC of and then
/// `bytes`.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace kelpie::file
