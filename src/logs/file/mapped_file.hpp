// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "file/descriptor.hpp"

namespace kelpie::file {

/// The content of a file, mapped into memory for the lifetime of the object. The file must not
/// shrink meanwhile. Throws InputError (file) for a missing or unreadable file and for a folder.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  friend class SharedFile;
  MappedFile() = default;
  void map(const std::filesystem::path& file, const Descriptor& descriptor, std::size_t size,
           int protection, int flags);

  std::span<std::byte> bytes_;
};

/// An existing file in memory, which other programs map at the same time and see renewed. One
/// process writes: the file is locked until the object's end. The file must not shrink meanwhile.
/// Throws InputError (file) where the file is missing, no regular file, not writable, empty, or
/// locked by another writer; Failure where the disk has no room for holes of the file.
class SharedFile {
 public:
  explicit SharedFile(const std::filesystem::path& file);

  std::span<std::byte> bytes() const { return content_.bytes_; }

 private:
  Descriptor descriptor_;
  MappedFile content_;
};

/// Whether a process writes the file as a SharedFile at present.
bool is_shared(const std::filesystem::path& file);

}  // namespace kelpie::file
