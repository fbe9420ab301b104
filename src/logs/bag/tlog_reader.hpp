// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bag/reader.hpp"

namespace kelpie::bag {

/// Whether the beginning of a file (some thousand bytes) holds a MAVLink frame behind a time stamp.
bool begins_as_tlog(std::string_view beginning);

/// Reads a .tlog file of a ground station (QGroundControl, Mission Planner, MAVProxy): MAVLink 1
/// and 2, before each frame the time of reception in µs since 1970, 8 bytes, big-endian. `bytes` is
/// the content and has to outlive the reader; messages call it `file`. A topic per message and
/// sender (mavlink_topic). The vehicle is the autopilot whose HEARTBEAT is in the file; with
/// several autopilots, no sender is the vehicle. Messages without a definition, and messages of a
/// sender whose checksum is never right (another definition), become topics that cannot be decoded.
/// Frames with a wrong checksum, of a sender whose checksum of the message is right elsewhere, are
/// passed over and counted (BlueOS issue 1740: damaged DISTANCE_SENSORs in almost every log).
/// Throws InputError (file, offset) on bytes outside of frames and a cut-off file, in strict mode
/// on a wrong checksum too. Recover mode: continues with the next frame with a right checksum.
/// Cost: two passes over the frames. Memory: the topics.
std::unique_ptr<MessageReader> read_tlog(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode);

}  // namespace kelpie::bag
