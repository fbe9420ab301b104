// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bag/reader.hpp"

namespace kelpie::bag {

bool begins_as_ros1(std::string_view beginning);

/// Reads a bag of ROS 1, version 2.0 (http://wiki.ros.org/Bags/Format/2.0), from beginning to end:
/// chunks may be plain, bz2 or lz4. `bytes` is the content and has to outlive the reader; messages
/// call it `file`. All connections of a topic form one topic and need the same type.
/// Throws InputError (file, offset) on other files and on encrypted bags. Strict mode: also on a
/// bag that was never closed (`.active` files), a cut-off file, damaged records or chunks, and
/// missing chunks or messages. Recover mode: continues with the next whole record, also within a
/// plain chunk that is cut off.
/// Memory: the definitions and one unpacked chunk; the stored size of a chunk is accepted only in
/// proportion to the packed bytes.
std::unique_ptr<MessageReader> read_ros1(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode);

}  // namespace kelpie::bag
