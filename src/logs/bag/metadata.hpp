// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kelpie::bag {

/// The files that rosbag2's metadata.yaml lists, relative to the bag's folder, in the order of
/// recording. Of a path that leads out of the folder, as absolute paths of the recording machine,
/// the file's name counts. Throws InputError (file, line, key): missing, no YAML, no rosbag2
/// metadata, an unknown storage, a bag compressed by rosbag2, no name of a file.
std::vector<std::string> read_metadata(const std::filesystem::path& file);

}  // namespace kelpie::bag
