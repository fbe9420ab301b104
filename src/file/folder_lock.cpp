// SPDX-License-Identifier: Apache-2.0
#include "file/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

namespace kelpie::file {
namespace {

// The file itself can't be locked: writing puts another one in its place.
std::filesystem::path folder_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::weakly_canonical(file, error);
  return error || !place.has_parent_path() ? "." : place.parent_path();
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& file)
    : folder_(::open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {  // NOLINT
  while (folder_ >= 0 && ::flock(folder_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) {
    ::close(folder_);
  }
}

}  // namespace kelpie::file
