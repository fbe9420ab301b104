// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bag/bag.hpp"

namespace kelpie::bag {

/// Whether a file that begins so is of DataFlash messages.
bool begins_as_dataflash(std::string_view bytes);

/// Reads a .BIN file as ArduPilot's DataFlash writes it: messages, each behind A3 95 and its
/// number, which FMT defines. `bytes` is the file's content and has to outlive the reader; messages
/// call it `file`. A topic per message, "ATT", or per instance of it, "IMU[0]", where FMTU has
/// marked a field as its instance (as pymavlink calls them). FMT, FMTU, UNIT and MULT are
/// definitions and no messages. Times are TimeUS, since 1970 where a GPS with a fix tells the time,
/// else since the autopilot began; what has no time has that of the message before.
/// Throws InputError (file, offset) on what is no message, one that no FMT defines or two define
/// differently, a second log in the same file, a file that is cut off.
/// Recover mode: goes on with the next message that is followed by another one. A second log comes
/// a minute after the first.
/// Cost: hops through the file once more at the start. Memory: the topics.
std::unique_ptr<BagReader> read_dataflash(std::span<const std::byte> bytes, const std::string& file,
                                          ReadMode mode);

/// The same of a file, which is mapped into memory and must not shrink meanwhile.
std::unique_ptr<BagReader> read_dataflash(const std::filesystem::path& file, ReadMode mode);

}  // namespace kelpie::bag
