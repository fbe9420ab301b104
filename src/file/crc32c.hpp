// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace kelpie::file {

/// The CRC-32C (Castagnoli) of `bytes`, or of what `before` is the CRC of and then `bytes`. About a
/// nanosecond a byte.
std::uint32_t crc32c(std::string_view bytes, std::uint32_t before = 0);

}  // namespace kelpie::file
