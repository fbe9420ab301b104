// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "bag/bag.hpp"

namespace kelpie::bag {

/// Reads a bag of ROS 1, version 2.0 (http://wiki.ros.org/Bags/Format/2.0), from its beginning to
/// its end: chunks that are plain, or packed by bz2 or lz4. `bytes` is the file's content and has
/// to outlive the reader; messages call it `file`. All connections of a topic are one topic; they
/// have to have one type. Throws InputError (file, offset) when it isn't such a bag, and when it is
/// encrypted. Strict mode: also when it was never closed (`.active` files) or is cut off, a record
/// or chunk is damaged, and when chunks or messages are missing by the end. Recover mode: goes on
/// with the next record that is whole; of a plain chunk that is cut off, its messages are read.
/// Memory: the definitions and one unpacked chunk, whose size is believed only in proportion to
/// what is stored.
std::unique_ptr<BagReader> read_ros1(std::span<const std::byte> bytes, const std::string& file,
                                     ReadMode mode);

/// The same of a file, which is mapped into memory and must not shrink meanwhile.
std::unique_ptr<BagReader> read_ros1(const std::filesystem::path& file, ReadMode mode);

}  // namespace kelpie::bag
