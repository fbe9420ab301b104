// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kelpie::bag {

/// The parts of rosbag2's metadata.yaml needed for reading.
struct BagMetadata {
  std::string storage;             ///< "sqlite3" or "mcap"
  std::vector<std::string> files;  ///< relative to the bag's folder, in the order of recording
};

/// Throws InputError (file, line, key): missing, no YAML, no rosbag2 metadata, an unknown storage,
/// a bag compressed by rosbag2, a file outside of the bag's folder.
BagMetadata read_metadata(const std::filesystem::path& file);

}  // namespace kelpie::bag
