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

/// Whether a file that begins so is ULog, of whatever version.
bool begins_as_ulog(std::string_view bytes);

/// Reads a ULog file (https://docs.px4.io/main/en/dev_log/ulog_file_format.html), versions 0 and 1,
/// with or without appended data. `bytes` is the file's content and has to outlive the reader;
/// messages call it `file`. A topic per subscription: "sensor_accel", "sensor_accel[1]" for the
/// second instance; and "dropout" for the messages that tell for how long nothing was recorded.
/// Times are the field timestamp, since 1970 where a GPS tells the time, else since the autopilot
/// began; what has none has that of the message before. Texts, parameters and information are
/// passed over.
/// Throws InputError (file, offset) on what is no message, a size that isn't that of the format, a
/// subscription that isn't there, a file that is cut off, an encrypted one, one that needs what
/// kelpie doesn't know.
/// Recover mode: goes on with the next mark of synchronisation, or two messages that are sound.
/// Cost: hops through the file once more at the start. Memory: formats and topics.
std::unique_ptr<BagReader> read_ulog(std::span<const std::byte> bytes, const std::string& file,
                                     ReadMode mode);

/// The same of a file, which is mapped into memory and must not shrink meanwhile.
std::unique_ptr<BagReader> read_ulog(const std::filesystem::path& file, ReadMode mode);

}  // namespace kelpie::bag
