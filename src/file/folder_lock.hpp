// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "file/descriptor.hpp"

namespace kelpie::file {

/// Holds a lock of a folder; further holders in any process wait. Protects the sequence of reading,
/// changing and writing a file against lost changes. Leaves no file behind. Without file locks
/// (some network drives), or if the folder cannot be opened, no holder waits.
class FolderLock {
 public:
  /// Locks the folder of `file`. Waits for the current holder.
  explicit FolderLock(const std::filesystem::path& file);

 private:
  Descriptor folder_;
};

}  // namespace kelpie::file
