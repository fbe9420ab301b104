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

bool Descriptor::write(std::string_view content, std::size_t begin) const {
  while (!content.empty()) {
    const ssize_t written =
        ::pwrite(number_, content.data(), content.size(), static_cast<off_t>(begin));
    if (written < 0 && errno != EINTR) {
      return false;
    }
    const std::size_t done = written > 0 ? static_cast<std::size_t>(written) : 0;
    content.remove_prefix(done);
    begin += done;
  }
  return true;
}

FolderLock::FolderLock(const std::filesystem::path& file)
    : folder_(folder_of(file), O_RDONLY | O_DIRECTORY) {
  if (folder_.is_open()) {
    folder_.lock(LOCK_EX);
  }
}

}  // namespace kelpie::file
