// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::bag {

/// Unpacks `packed` ("zstd", "lz4", "bz2" or "" for not packed) into `unpacked`, which gets `size`
/// bytes. Returns "" or what is wrong: an unknown compression, a size that can't be (so that a
/// damaged length doesn't allocate), damaged content, content of another size.
std::string unpack(std::string_view compression, std::span<const std::byte> packed,
                   std::uint64_t size, std::vector<std::byte>& unpacked);

/// Whether this many bytes may come of so many packed ones: beyond some MB, a size has to be backed
/// by stored bytes.
bool is_believable(std::uint64_t size, std::uint64_t packed);

/// Memory goes by the number of messages. Returns "", or what is wrong with this many messages out
/// of packed chunks of a bag of `bag_bytes`: in a recorded one the stamp alone takes more than a
/// byte of each, however well it is packed.
std::string check_unpacked(std::uint64_t messages, std::uint64_t bag_bytes);

/// Packs by "zstd", "lz4" or "". The same bytes give the same result.
std::string pack(std::string_view compression, std::string_view bytes);

}  // namespace kelpie::bag
