// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bag/reader.hpp"

namespace kelpie::bag {

bool begins_as_mcap(std::string_view beginning);

/// Reads a recording in MCAP (https://mcap.dev/spec): with or without chunks (zstd, lz4 or plain),
/// with or without summary. `bytes` is the content and has to outlive the reader; messages call it
/// `file`. All stored CRCs are checked.
/// Throws InputError (file, offset) on other files. Strict mode: also on a missing end of the file,
/// a damaged summary and, at the end, missing messages or a wrong CRC of the data. Recover mode:
/// skips damaged chunks; after a damaged record, reading continues at the next chunk that the
/// summary names.
/// Memory: the definitions and one unpacked chunk; the stored size of a chunk is accepted only in
/// proportion to the packed bytes.
std::unique_ptr<MessageReader> read_mcap(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode);

}  // namespace kelpie::bag
