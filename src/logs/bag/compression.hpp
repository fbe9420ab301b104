// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::bag {

/// Unpacks `packed` ("zstd", "lz4", "bz2", or "" for plain bytes) into `unpacked`, which gets
/// `size` bytes. Returns "" or an error: unknown compression, implausible size (so that a damaged
/// length does not allocate), damaged content, content of another size.
std::string unpack(std::string_view compression, std::span<const std::byte> packed,
                   std::uint64_t size, std::vector<std::byte>& unpacked);

/// Whether `size` bytes may come from `packed` bytes: beyond some MB, the ratio is limited.
bool is_believable(std::uint64_t size, std::uint64_t packed);

/// Limits the number of messages, hence the memory. Returns "", or an error when `messages` cannot
/// come from packed chunks of a recording of `bag_bytes`: in real recordings the time stamp alone
/// takes more than a byte per message, however well packed.
std::string check_unpacked(std::uint64_t messages, std::uint64_t bag_bytes);

/// Packs by "zstd", "lz4" or "". The same bytes give the same result.
std::string pack(std::string_view compression, std::string_view bytes);

}  // namespace kelpie::bag
