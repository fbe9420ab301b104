// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "bag/bag.hpp"

namespace kelpie::bag {

/// Reads a .db3 file as rosbag2's sqlite3 storage writes it (tables topics, messages and, since
/// ROS 2 Iron, message_definitions), in the order of recording. Recover mode: where the file is
/// damaged, reads on from its end backwards to the damage.
/// Throws InputError (file, message) when it isn't such a file or is damaged.
std::unique_ptr<BagReader> read_sqlite_bag(const std::filesystem::path& file, ReadMode mode);

}  // namespace kelpie::bag
