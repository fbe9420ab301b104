// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::bag {

/// Unpacks `packed` ("zstd", "lz4" or "" for not packed) into `unpacked`, which gets `size` bytes.
/// Returns "" or what is wrong: an unknown compression, a size that can't be (so that a damaged
/// length doesn't allocate), damaged content, content of another size.
std::string unpack(std::string_view compression, std::span<const std::byte> packed,
                   std::uint64_t size, std::vector<std::byte>& unpacked);

/// Packs by "zstd", "lz4" or "". The same bytes give the same result.
std::string pack(std::string_view compression, std::string_view bytes);

}  // namespace kelpie::bag
