// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kelpie::bag {

/// What of rosbag2's metadata.yaml is needed to find its messages.
struct BagMetadata {
  std::string storage;             ///< "sqlite3" or "mcap"
  std::vector<std::string> files;  ///< relative to the bag's folder, in the order of recording
};

/// Throws InputError (file, line, key): missing, no YAML, no rosbag2 metadata, an unknown storage,
/// a bag that rosbag2 compressed, a file outside of the bag's folder.
BagMetadata read_metadata(const std::filesystem::path& file);

}  // namespace kelpie::bag
