// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "file/descriptor.hpp"

namespace kelpie::file {

/// Keeps others who hold one for the same folder waiting until the end of its scope, in whatever
/// program, so that a file there can be read, changed and written again without losing what they
/// write. Leaves no file behind. Where the file system knows no locks (some network drives) or the
/// folder can't be opened, it keeps nobody waiting.
class FolderLock {
 public:
  /// Of the folder that holds `file`. Waits for the others.
  explicit FolderLock(const std::filesystem::path& file);

 private:
  Descriptor folder_;
};

}  // namespace kelpie::file
