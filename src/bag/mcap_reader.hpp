// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "bag/bag.hpp"

namespace kelpie::bag {

/// Reads a bag in MCAP (https://mcap.dev/spec): with and without chunks (zstd, lz4 or plain), with
/// and without summary. `bytes` is the file's content and has to outlive the reader; messages call
/// it `file`. Every CRC that is there is checked.
/// Throws InputError (file, offset) when it isn't MCAP. Strict mode: also when the file doesn't end
/// as MCAP ends, its summary is damaged, and, at the end, when messages are missing or the CRC of
/// the whole is wrong. Recover mode: a damaged chunk is passed over; after a damaged record reading
/// goes on at the next chunk that the summary names, if there is a summary.
/// Memory: the definitions and one unpacked chunk, whose size is believed only in proportion to
/// what is stored.
std::unique_ptr<BagReader> read_mcap(std::span<const std::byte> bytes, const std::string& file,
                                     ReadMode mode);

/// The same of a file, which is mapped into memory and must not shrink meanwhile.
std::unique_ptr<BagReader> read_mcap(const std::filesystem::path& file, ReadMode mode);

}  // namespace kelpie::bag
