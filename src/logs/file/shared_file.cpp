// SPDX-License-Identifier: Apache-2.0
#include "file/shared_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "kelpie/core/error.hpp"

namespace kelpie::file {
namespace {

[[noreturn]] void refuse_sharing(const std::filesystem::path& file, const std::string& reason) {
  throw InputError({.file = file.string(), .line = 0, .field = {}}, reason);
}

}  // namespace

SharedFile::SharedFile(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CLOEXEC)) {  // NOLINT: POSIX is variadic
  struct stat status = {};
  if (!descriptor_.is_open() || ::fstat(descriptor_.number(), &status) != 0) {
    refuse_sharing(file,
                   "cannot be opened to be renewed: " + std::generic_category().message(errno));
  }
  if (!S_ISREG(status.st_mode) || status.st_size == 0) {
    refuse_sharing(file, "is not a regular file with content");
  }
  if (!descriptor_.lock(LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK) {
    refuse_sharing(file, "is renewed by another process");
  }
  // Memory of a hole in the file would end the process by SIGBUS, once the disk is full.
  if (const int error = ::posix_fallocate(descriptor_.number(), 0, status.st_size)) {
    throw Failure(file.string() +
                  ": has no room on the disk: " + std::generic_category().message(error));
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const content =
      ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_.number(), 0);
  if (content == MAP_FAILED) {
    refuse_sharing(file, "cannot be mapped: " + std::generic_category().message(errno));
  }
  bytes_ = {static_cast<std::byte*>(content), size};
}

SharedFile::~SharedFile() {
  ::munmap(bytes_.data(), bytes_.size());
}

bool is_shared(const std::filesystem::path& file) {
  const Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));  // NOLINT: as above
  return descriptor.is_open() && !descriptor.lock(LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK;
}

}  // namespace kelpie::file
