// SPDX-License-Identifier: Apache-2.0
#include "file/out_folder.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <system_error>
#include <utility>

#include "file/atomic_file.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::file {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = ".kelpie.lock";

// Of the folder and those it is in, what isn't there, the innermost first.
std::vector<fs::path> missing_folders(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, error); at = at.parent_path()) {
    missing.push_back(at);
  }
  return missing;
}

// Its owner removes a lock: the name may be that of another file by now, or of none.
bool is_at(const Descriptor& file, const fs::path& path) {
  struct stat here = {};
  struct stat there = {};
  return ::fstat(file.number(), &here) == 0 && ::stat(path.c_str(), &there) == 0 &&
         here.st_ino == there.st_ino && here.st_dev == there.st_dev;
}

}  // namespace

OutFolder::OutFolder(fs::path folder)
    : folder_(std::move(folder)), made_(missing_folders(folder_)) {}

// Delegating: the object counts as made before take(), so that the destructor tidies up.
OutFolder::OutFolder(fs::path folder, const std::vector<std::string>& names)
    : OutFolder(std::move(folder)) {
  make_folder(folder_);
  take();
  for (const std::string& name : names) {
    check_writable(folder_ / name);
    remove_drafts(folder_ / name);
  }
}

OutFolder::~OutFolder() {
  if (lock_ != nullptr) {
    ::unlink((folder_ / kLockName).c_str());
  }
  for (const fs::path& folder : made_) {
    ::rmdir(folder.c_str());
  }
}

void OutFolder::take() {
  const fs::path file = folder_ / kLockName;
  for (;;) {
    auto lock = std::make_unique<Descriptor>(file, O_RDWR | O_CREAT);
    if (!lock->is_open()) {
      throw Failure(fmt::format("{}: cannot be written: {}", folder_.string(),
                                std::generic_category().message(errno)));
    }
    if (!lock->lock(LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK) {
      throw InputError({.file = folder_.string(), .field = "--out"},
                       "another run is writing into this folder; give another one, or wait");
    }
    if (is_at(*lock, file)) {
      lock_ = std::move(lock);
      return;
    }
  }
}

}  // namespace kelpie::file
