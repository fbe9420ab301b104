// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bag/reader.hpp"

namespace kelpie::bag {

/// Whether a file begins with a DataFlash message.
bool begins_as_dataflash(std::string_view beginning);

/// Reads a .BIN file of ArduPilot's DataFlash: messages behind A3 95 and a number, defined by FMT.
/// `bytes` is the content and has to outlive the reader; messages call it `file`. A topic per
/// message, "ATT", or per instance, "IMU[0]", where FMTU marks a field as the instance (names as in
/// pymavlink). FMT, FMTU, UNIT and MULT are definitions, not messages. Times are TimeUS, since 1970
/// if a GPS with a fix gives the date, else since the start of the autopilot; a message without
/// time gets the time of the previous message. Throws InputError (file, offset) on bytes outside of
/// messages, undefined messages, conflicting definitions, a second log in the same file, a cut-off
/// file. Recover mode: continues with the next message that is followed by another message. A
/// second log starts one minute after the end of the first. Cost: two passes over the file. Memory:
/// the topics.
std::unique_ptr<MessageReader> read_dataflash(std::span<const std::byte> bytes,
                                              const std::string& file, ReadMode mode);

}  // namespace kelpie::bag
