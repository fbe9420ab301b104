// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

namespace kelpie::file {

/// An open file or folder, closed at the end of its scope.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags)
      : number_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {}  // NOLINT: POSIX is variadic
  ~Descriptor() {
    if (is_open()) {
      ::close(number_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;

  bool is_open() const { return number_ >= 0; }
  int number() const { return number_; }

  /// Locks it against others who lock it, until it is closed; `how` is LOCK_EX, with LOCK_NB not to
  /// wait. False where it isn't locked, for the reason in errno (EWOULDBLOCK: somebody has it).
  bool lock(int how) const {
    int failed = ::flock(number_, how);
    while (failed != 0 && errno == EINTR) {
      failed = ::flock(number_, how);
    }
    return failed == 0;
  }

 private:
  int number_;
};

}  // namespace kelpie::file
