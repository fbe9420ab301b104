// SPDX-License-Identifier: Apache-2.0
#include "file/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "file/descriptor.hpp"
#include "file/mapped_file.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::file {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Failure(fmt::format("{}: cannot be written: {}", file.string(), reason));
}

[[noreturn]] void fail(const fs::path& file, int error) {
  fail(file, std::generic_category().message(error));
}

// Where content for `file` has to go: renaming over a link or a device would replace it.
fs::path place_of(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) {
    return file;
  }
  if (!fs::is_regular_file(status)) {
    fail(file, fs::is_directory(status) ? "it is a folder" : "it is not a regular file");
  }
  return fs::is_symlink(fs::symlink_status(file, error)) ? fs::canonical(file) : file;
}

// Content written beside its place; it is published there, or vanishes.
class Draft {
 public:
  // Delegating: the object counts as made before write(), so that the destructor tidies up.
  Draft(const fs::path& file, const Content& content) : Draft(place_of(file)) {
    content.tell([this](std::string_view piece) { write(piece); });
    finish();
  }
  ~Draft() {
    if (!path_.empty()) {
      ::unlink(path_.c_str());
    }
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  void publish() {
    if (::rename(path_.c_str(), place_.c_str()) != 0) {
      fail(place_, errno);
    }
    path_.clear();
  }

  const fs::path& place() const { return place_; }

 private:
  explicit Draft(fs::path place) : place_(std::move(place)) {
    static std::atomic<unsigned> counter{0};
    fs::path path;
    // A process killed long ago may have had our number, in a container even surely. The lock tells
    // remove_drafts() that the writer lives; it may have come before the lock.
    do {
      path = place_;
      path += fmt::format(".{}-{}.tmp", ::getpid(), counter++);
      file_.emplace(path, O_WRONLY | O_CREAT | O_EXCL);
    } while (file_->is_open() ? file_->lock(LOCK_EX) && is_gone() : errno == EEXIST);
    if (!file_->is_open()) {
      fail(place_, errno);
    }
    path_ = std::move(path);
  }

  // NOLINTBEGIN(bugprone-unchecked-optional-access): the constructor has opened it
  bool is_gone() const {
    struct stat status = {};
    return ::fstat(file_->number(), &status) == 0 && status.st_nlink == 0;
  }

  void write(std::string_view content) {
    if (!file_->write(content, size_)) {
      fail(place_, errno);
    }
    size_ += content.size();
  }

  void finish() {
    if (::fsync(file_->number()) != 0) {
      fail(place_, errno);
    }
  }
  // NOLINTEND(bugprone-unchecked-optional-access)

  fs::path place_;
  fs::path path_;  // empty once published
  std::optional<Descriptor> file_;
  std::size_t size_ = 0;
};

// A rename survives a power cut only once its folder is synced. The new content is in place by
// now: a file system that can't sync folders (EINVAL) is no reason to report a failure.
void sync_folder(const fs::path& folder) {
  const Descriptor descriptor(folder, O_RDONLY | O_DIRECTORY);
  if (descriptor.is_open() && ::fsync(descriptor.number()) != 0 && errno != EINVAL) {
    fail(folder, errno);
  }
}

void keep_copy(const fs::path& file, const fs::path& to) {
  const MappedFile content(file);
  const auto* const text = reinterpret_cast<const char*>(content.bytes().data());  // NOLINT
  Draft draft(to, std::string(text, content.bytes().size()));
  draft.publish();
}

// The content of `file`, which is no symbolic link, under another name as well, by a link that
// takes the place of whatever has that name. Nothing where there is no such file.
void keep(const fs::path& file, const fs::path& previous) {
  const Descriptor old(file, O_RDWR);
  if (old.is_open()) {
    old.lock(LOCK_EX);  // as a draft's: the link is one
  }
  fs::path link = previous;
  link += fmt::format(".{}-link.tmp", ::getpid());
  ::unlink(link.c_str());
  const bool linked = ::link(file.c_str(), link.c_str()) == 0;
  if (!linked && errno == ENOENT) {
    return;
  }
  if (!linked && errno == EXDEV) {  // `previous` stands beside a symbolic link
    keep_copy(file, previous);
    return;
  }
  const fs::path& from = linked ? link : file;
  if (::rename(from.c_str(), previous.c_str()) != 0) {
    const int error = errno;
    ::unlink(link.c_str());
    fail(previous, error);
  }
  ::unlink(link.c_str());  // a rename between two names of one file does nothing
}

// Whether this is a name of a draft of `file` as Draft and keep() make them.
bool is_draft_of(std::string_view file, std::string_view name) {
  constexpr std::string_view kEnd = ".tmp";
  const auto digits = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (name.size() <= file.size() + 1 + kEnd.size() || !name.starts_with(file) ||
      name[file.size()] != '.' || !name.ends_with(kEnd)) {
    return false;
  }
  const std::string_view mark =
      name.substr(file.size() + 1, name.size() - file.size() - 1 - kEnd.size());
  const std::size_t dash = std::min(mark.find('-'), mark.size() - 1);
  const std::string_view number = mark.substr(dash + 1);
  return digits(mark.substr(0, dash)) && (digits(number) || number == "link");
}

fs::path parent_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

}  // namespace

Content::Content(std::string text)
    : tell_([text = std::move(text)](const Write& write) { write(text); }) {}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    fail(folder, error.value());
  }
}

void write_file_keeping(const fs::path& file, std::string_view content, const fs::path& previous) {
  Draft draft(file, std::string(content));
  keep(draft.place(), previous);
  draft.publish();
  sync_folder(parent_of(draft.place()));
}

void remove_drafts(const fs::path& file) {
  const std::string name = file.filename().string();
  std::error_code error;
  std::vector<fs::path> drafts;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent_of(file), error)) {
    if (is_draft_of(name, entry.path().filename().string()) && entry.is_regular_file(error)) {
      drafts.push_back(entry.path());
    }
  }
  for (const fs::path& draft : drafts) {
    const Descriptor descriptor(draft, O_RDWR);
    if (descriptor.is_open() && descriptor.lock(LOCK_EX | LOCK_NB)) {
      fs::remove(draft, error);
    }
  }
}

void check_writable(const fs::path& file) {
  const Draft draft(file, std::string());
}

void write_file_whole(const fs::path& file, std::string_view content) {
  Draft draft(file, std::string(content));
  draft.publish();
  remove_drafts(draft.place());
  sync_folder(parent_of(draft.place()));
}

void write_files_whole(const fs::path& folder, const FileSet& files) {
  make_folder(folder);
  std::deque<Draft> drafts;
  for (const auto& [name, content] : files) {
    if (content) {
      drafts.emplace_back(folder / name, *content);
    }
  }
  // First: an old file is never seen beside new ones that it doesn't belong to.
  for (const auto& [name, content] : files) {
    if (!content && ::unlink((folder / name).c_str()) != 0 && errno != ENOENT) {
      fail(folder / name, errno);
    }
  }
  for (Draft& draft : drafts) {
    draft.publish();
    remove_drafts(draft.place());
  }
  sync_folder(folder);
}

}  // namespace kelpie::file
