// SPDX-License-Identifier: Apache-2.0
#include "file/descriptor.hpp"

#include <system_error>

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
    : folder_(folder_of(file), O_RDONLY | O_DIRECTORY) {
  if (folder_.is_open()) {
    folder_.lock(LOCK_EX);
  }
}

}  // namespace kelpie::file
