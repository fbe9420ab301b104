// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "bag/reader.hpp"

namespace kelpie::bag {

/// The recordings that open_bag() reads, for help texts and messages: "a rosbag2 folder, or one
/// .db3, .mcap, … file".
const std::string& recording_formats();

/// Whether the path is a folder, or a regular file that begins as a known format. False for
/// unreadable files and for pipes.
bool is_bag(const std::filesystem::path& path);

/// Whether the file's format (MATLAB) has rows that may lack times.
bool may_lack_times(const std::filesystem::path& file);

/// Opens a recording: a rosbag2 folder with metadata.yaml (sqlite3 or MCAP storage), or a file of
/// one of recording_formats(), recognised by content. `times` apply where may_lack_times(). In
/// recover mode a folder may lack metadata.yaml or files. Throws InputError naming the file:
/// missing, empty, of an unknown format or storage, compressed by rosbag2, cut off.
std::unique_ptr<MessageReader> open_bag(const std::filesystem::path& path,
                                        ReadMode mode = ReadMode::usual,
                                        const RowTimes& times = {});

/// The same of the content of a file (not SQLite or MATLAB), which has to outlive the reader.
/// Messages call the content `file`.
std::unique_ptr<MessageReader> open_bytes(std::span<const std::byte> bytes, const std::string& file,
                                          ReadMode mode);

}  // namespace kelpie::bag
