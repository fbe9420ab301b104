// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "file/descriptor.hpp"

namespace kelpie::file {

/// An existing file in memory, which other programs map at the same time and see renewed. One
/// process writes: the file is locked until the object's end. The file must not shrink meanwhile.
/// Throws InputError (file) where the file is missing, no regular file, not writable, empty, or
/// locked by another writer; Failure where the disk has no room for holes of the file.
class SharedFile {
 public:
  explicit SharedFile(const std::filesystem::path& file);
  ~SharedFile();
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  std::span<std::byte> bytes() const { return bytes_; }

 private:
  Descriptor descriptor_;
  std::span<std::byte> bytes_;
};

/// Whether a process writes the file as a SharedFile at present.
bool is_shared(const std::filesystem::path& file);

}  // namespace kelpie::file
