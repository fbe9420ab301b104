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

/// What a file has to hold: a text, or what is told piece by piece when the file is written, which
/// needn't all be in memory then.
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

/// Writes `content` to a file beside `file`, syncs it and renames it over `file`, so that a reader
/// sees the old content or the new, never a part. A symbolic link stays and its file is replaced.
/// Throws Failure naming the file and the system's reason: the folder is missing or can't be
/// written, the disk is full, `file` is a folder or a device. Nothing is left behind then.
void write_file_whole(const std::filesystem::path& file, std::string_view content);

/// The same, and the old content stays as `previous` beside it. There is always a whole `file`, but
/// on a file system without hard links: there, for a moment, `previous` is the only one.
void write_file_keeping(const std::filesystem::path& file, std::string_view content,
                        const std::filesystem::path& previous);

/// Files of one folder by name; one without content doesn't belong to the set.
using FileSet = std::map<std::string, std::optional<Content>>;

/// write_file_whole() for several files of one folder (made if missing): all are written beside
/// their places before the first is renamed, so that a full disk leaves the old set untouched. An
/// old file that doesn't belong to the set is removed.
void write_files_whole(const std::filesystem::path& folder, const FileSet& files);

/// Removes what writers of `file` that were killed have left beside it. Those who are still at work
/// keep theirs (but nothing is removed where the file system knows no locks). Whoever writes a file
/// does this by itself.
void remove_drafts(const std::filesystem::path& file);

/// Throws what write_file_whole() would throw now, but for a full disk. Changes nothing.
void check_writable(const std::filesystem::path& file);

/// Makes a folder, with those it is in, where it is missing. Throws Failure.
void make_folder(const std::filesystem::path& folder);

}  // namespace kelpie::file
