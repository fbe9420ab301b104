// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "bag/bag.hpp"

namespace kelpie::bag {

/// Whether the beginning of a file, a few thousand bytes if it has them, holds a frame of MAVLink
/// with a time stamp before it.
bool begins_as_tlog(std::span<const std::byte> bytes);

/// Reads a .tlog file as ground stations write it (QGroundControl, Mission Planner, MAVProxy):
/// MAVLink 1 and 2, before each frame the time in µs since 1970 at which it was received, 8 bytes,
/// the highest first. `bytes` is the file's content and has to outlive the reader; messages call it
/// `file`. A topic per message and sender (mavlink_topic); the vehicle is the one autopilot whose
/// HEARTBEAT is in the file, or nobody where there are several. Messages without a definition,
/// and those of which no frame of a sender has the right checksum (it has another definition), are
/// topics that can't be decoded.
/// Throws InputError (file, offset) on what is no frame, a wrong checksum, a file that is cut off.
/// Recover mode: goes on with the next frame whose checksum is right.
/// Cost: what may be a frame is looked at once more at the start. Memory: the topics.
std::unique_ptr<BagReader> read_tlog(std::span<const std::byte> bytes, const std::string& file,
                                     ReadMode mode);

/// The same of a file, which is mapped into memory and must not shrink meanwhile.
std::unique_ptr<BagReader> read_tlog(const std::filesystem::path& file, ReadMode mode);

}  // namespace kelpie::bag
