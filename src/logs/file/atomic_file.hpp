// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace kelpie::file {

/// Content of a file: a text, or pieces produced while writing, so that the whole content need not
/// be in memory.
class Content {
 public:
  using Write = std::function<void(std::string_view piece)>;

  Content(std::string text);  // NOLINT(google-explicit-constructor): most files are texts
  Content(const char* text) : Content(std::string(text)) {}  // NOLINT(google-explicit-constructor)
  explicit Content(std::function<void(const Write& write)> tell) : tell_(std::move(tell)) {}

  void tell(const Write& write) const { tell_(write); }

 private:
  std::function<void(const Write&)> tell_;
};

/// Writes `content` to a temporary file beside `file`, syncs and renames, so that a reader sees the
/// old content or the new content, never a part. A symbolic link stays; the target is replaced.
/// Throws Failure naming the file and the system's reason: missing or read-only folder, full disk,
/// `file` is a folder or a device. A failed call leaves no file behind.
void write_file_whole(const std::filesystem::path& file, std::string_view content);

/// Writes as write_file_whole(), and keeps the old content as `previous`. A whole `file` exists at
/// any time, except for a moment on a file system without hard links, where only `previous` exists.
void write_file_keeping(const std::filesystem::path& file, std::string_view content,
                        const std::filesystem::path& previous);

/// Files of a folder by name; a file without content is removed.
using FileSet = std::map<std::string, std::optional<Content>>;

/// Writes several files of a folder (made if missing): all temporary files are complete before the
/// first rename, so that a full disk leaves the old set untouched. Old files without content in the
/// set are removed.
void write_files_whole(const std::filesystem::path& folder, const FileSet& files);

/// Removes temporary files of `file` left by killed writers. Files of running writers stay (without
/// file locks, all files stay). Every writer of a file calls this function.
void remove_drafts(const std::filesystem::path& file);

/// Throws what write_file_whole() would throw now, except for a full disk. Changes no file.
void check_writable(const std::filesystem::path& file);

/// Makes a missing folder, including the parents. Throws Failure.
void make_folder(const std::filesystem::path& folder);

}  // namespace kelpie::file
