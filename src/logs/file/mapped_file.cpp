// SPDX-License-Identifier: Apache-2.0
#include "file/mapped_file.hpp"

#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "kelpie/core/error.hpp"

namespace kelpie::file {
namespace {

[[noreturn]] void refuse_mapping(const std::filesystem::path& file, const std::string& reason) {
  throw InputError({.file = file.string(), .line = 0, .field = {}}, reason);
}

std::string last_error() {
  return std::generic_category().message(errno);
}

// Size of a file to read.
std::size_t size_to_read(const std::filesystem::path& file, const Descriptor& descriptor) {
  struct stat status = {};
  if (!descriptor.is_open() || ::fstat(descriptor.number(), &status) != 0) {
    refuse_mapping(file, "cannot be read: " + last_error());
  }
  if (!S_ISREG(status.st_mode)) {
    refuse_mapping(file, "cannot be read: it is not a regular file");
  }
  return static_cast<std::size_t>(status.st_size);
}

// Locks a file to be renewed; its size.
std::size_t size_to_renew(const std::filesystem::path& file, const Descriptor& descriptor) {
  struct stat status = {};
  if (!descriptor.is_open() || ::fstat(descriptor.number(), &status) != 0) {
    refuse_mapping(file, "cannot be opened to be renewed: " + last_error());
  }
  if (!S_ISREG(status.st_mode) || status.st_size == 0) {
    refuse_mapping(file, "is not a regular file with content");
  }
  if (!descriptor.lock(LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK) {
    refuse_mapping(file, "is renewed by another process");
  }
  // Memory of a hole in the file would end the process by SIGBUS, once the disk is full.
  if (const int error = ::posix_fallocate(descriptor.number(), 0, status.st_size)) {
    throw Failure(file.string() +
                  ": has no room on the disk: " + std::generic_category().message(error));
  }
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& file) {
  const Descriptor descriptor(file, O_RDONLY);
  map(file, descriptor, size_to_read(file, descriptor), PROT_READ, MAP_PRIVATE);
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) {
    ::munmap(bytes_.data(), bytes_.size());
  }
}

void MappedFile::map(const std::filesystem::path& file, const Descriptor& descriptor,
                     std::size_t size, int protection, int flags) {
  if (size == 0) {
    return;
  }
  void* const content = ::mmap(nullptr, size, protection, flags, descriptor.number(), 0);
  if (content == MAP_FAILED) {
    refuse_mapping(file, "cannot be mapped: " + last_error());
  }
  bytes_ = {static_cast<std::byte*>(content), size};
}

SharedFile::SharedFile(const std::filesystem::path& file) : descriptor_(file, O_RDWR) {
  content_.map(file, descriptor_, size_to_renew(file, descriptor_), PROT_READ | PROT_WRITE,
               MAP_SHARED);
}

bool is_shared(const std::filesystem::path& file) {
  const Descriptor descriptor(file, O_RDONLY);
  return descriptor.is_open() && !descriptor.lock(LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK;
}

}  // namespace kelpie::file
