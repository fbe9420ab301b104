// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bag/reader.hpp"

namespace kelpie::bag {

/// Whether a file begins as ULog, of any version.
bool begins_as_ulog(std::string_view beginning);

/// Reads a ULog file (https://docs.px4.io/main/en/dev_log/ulog_file_format.html), versions 0 and 1,
/// with or without appended data. `bytes` is the content and has to outlive the reader; messages
/// call it `file`. A topic per subscription: "sensor_accel", "sensor_accel[1]" for the second
/// instance; and "dropout" for gaps in the recording. Times are the field timestamp, since 1970 if
/// a GPS gives the date, else since the start of the autopilot; a message without timestamp gets
/// the time of the previous message. Texts, parameters and information are skipped.
/// Throws InputError (file, offset) on unknown message types, sizes other than the format's,
/// missing subscriptions, cut-off and encrypted files, unknown incompatible flags.
/// Recover mode: continues at the next synchronisation mark, or at two consecutive sound messages.
/// Cost: one more pass over the file, up to the first date. Memory: formats and topics.
std::unique_ptr<MessageReader> read_ulog(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode);

}  // namespace kelpie::bag
