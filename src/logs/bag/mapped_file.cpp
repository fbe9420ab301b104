// SPDX-License-Identifier: Apache-2.0
#include "bag/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

[[noreturn]] void refuse_mapping(const std::filesystem::path& file, const std::string& reason) {
  throw InputError({.file = file.string()}, "cannot be read: " + reason);
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);  // NOLINT: POSIX is variadic
  struct stat status = {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    refuse_mapping(file, std::generic_category().message(errno));
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const content = S_ISREG(status.st_mode) && size > 0
                            ? ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0)
                            : nullptr;
  const int error = errno;
  ::close(descriptor);
  if (!S_ISREG(status.st_mode)) {
    refuse_mapping(file, "it is not a regular file");
  }
  if (content == MAP_FAILED) {
    refuse_mapping(file, std::generic_category().message(error));
  }
  bytes_ = {static_cast<std::byte*>(content), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) {
    ::munmap(bytes_.data(), bytes_.size());
  }
}

}  // namespace kelpie::bag
