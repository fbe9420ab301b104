// SPDX-License-Identifier: Apache-2.0
#include "kelpie/data/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int error) {
  throw Failure(file.string() + ": cannot be written: " + std::generic_category().message(error));
}

class Descriptor {
 public:
  Descriptor(const fs::path& file, int flags)
      : number_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {}  // NOLINT: POSIX is variadic
  ~Descriptor() {
    if (number_ >= 0) {
      ::close(number_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

// A file beside its place, that is moved there or vanishes.
class Draft {
 public:
  Draft(fs::path place, std::string_view content) : place_(std::move(place)) {
    static std::atomic<unsigned> counter{0};
    draft_ = place_;
    draft_ += "." + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
    const Descriptor file(draft_, O_WRONLY | O_CREAT | O_EXCL);
    if (file.number() < 0) {
      const int error = errno;
      draft_.clear();
      fail(place_, error);
    }
    write_all(file.number(), content);
  }
  ~Draft() {
    if (!draft_.empty()) {
      ::unlink(draft_.c_str());
    }
  }
  Draft(Draft&& other) noexcept : place_(std::move(other.place_)), draft_(std::move(other.draft_)) {
    other.draft_.clear();
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  Draft& operator=(Draft&&) = delete;

  void publish() {
    if (::rename(draft_.c_str(), place_.c_str()) != 0) {
      fail(place_, errno);
    }
    draft_.clear();
  }

 private:
  // The destructor doesn't run for an object whose constructor throws.
  [[noreturn]] void abandon(int error) {
    ::unlink(draft_.c_str());
    fail(place_, error);
  }

  void write_all(int file, std::string_view content) {
    while (!content.empty()) {
      const ssize_t written = ::write(file, content.data(), content.size());
      if (written < 0 && errno != EINTR) {
        abandon(errno);
      }
      content.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
    }
    if (::fsync(file) != 0) {
      abandon(errno);
    }
  }

  fs::path place_;
  fs::path draft_;
};

// A rename is only safe on disk once its folder is.
void sync_folder(const fs::path& folder) {
  const Descriptor descriptor(folder, O_RDONLY | O_DIRECTORY);
  if (descriptor.number() >= 0) {
    ::fsync(descriptor.number());
  }
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

void write_file_whole(const fs::path& file, std::string_view content) {
  Draft draft(file, content);
  draft.publish();
  sync_folder(folder_of(file));
}

void write_files_whole(const fs::path& folder,
                       const std::map<std::string, std::string>& content_by_name) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    fail(folder, error.value());
  }
  std::vector<Draft> drafts;
  for (const auto& [name, content] : content_by_name) {
    drafts.emplace_back(folder / name, content);
  }
  for (Draft& draft : drafts) {
    draft.publish();
  }
  sync_folder(folder);
}

}  // namespace kelpie
