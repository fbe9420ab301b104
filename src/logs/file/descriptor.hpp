// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <string_view>

namespace kelpie::file {

/// An open file or folder, closed in the destructor.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags)
      : number_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {}  // NOLINT: POSIX is variadic
  explicit Descriptor(int number) : number_(number) {}             ///< Takes an open file over.
  ~Descriptor() {
    if (is_open()) {
      ::close(number_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool is_open() const { return number_ >= 0; }
  int number() const { return number_; }

  /// Locks the file against other holders until closed; `how` is LOCK_EX, with LOCK_NB for no
  /// waiting. Returns false without lock, with the reason in errno (EWOULDBLOCK: locked by another
  /// holder).
  bool lock(int how) const {
    int failed = ::flock(number_, how);
    while (failed != 0 && errno == EINTR) {
      failed = ::flock(number_, how);
    }
    return failed == 0;
  }

  /// Writes all of `content` from the byte `begin` on. Returns false with the reason in errno where
  /// the file takes no more.
  bool write(std::string_view content, std::size_t begin) const;

 private:
  int number_;
};

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
