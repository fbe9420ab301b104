// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "bag/reader.hpp"

namespace kelpie::bag {

bool begins_as_sqlite(std::string_view beginning);

/// Reads a .db3 file of rosbag2's sqlite3 storage (tables topics, messages and, since ROS 2 Iron,
/// message_definitions), in the order of recording. Recover mode: behind damage, reads backwards
/// from the end of the table to the damage. `times` is not used.
/// Throws InputError (file, message) on other files and on damage.
std::unique_ptr<MessageReader> read_sqlite_bag(const std::filesystem::path& file, ReadMode mode,
                                               const RowTimes& times = {});

}  // namespace kelpie::bag
