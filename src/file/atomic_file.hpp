// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace kelpie::file {

/// Writes `content` to a file beside `file`, syncs it and renames it over `file`, so that a reader
/// sees the old content or the new, never a part. A symbolic link stays and its file is replaced.
/// Throws Failure naming the file and the system's reason: the folder is missing or can't be
/// written, the disk is full, `file` is a folder or a device. Nothing is left behind then.
void write_file_whole(const std::filesystem::path& file, std::string_view content);

/// The same, and the old content stays as `previous` beside it. There is always a whole `file`, but
/// on a file system without hard links: there, for a moment, `previous` is the only one.
void write_file_keeping(const std::filesystem::path& file, std::string_view content,
                        const std::filesystem::path& previous);

/// Removes what writers that were killed have left beside the files of a folder, if there is such a
/// folder. Requires that nobody is writing there.
void remove_drafts(const std::filesystem::path& folder);

/// write_file_whole() for several files of one folder (made if missing): all are written beside
/// their places before the first is renamed, so that a full disk leaves the old set untouched.
void write_files_whole(const std::filesystem::path& folder,
                       const std::map<std::string, std::string>& content_by_name);

}  // namespace kelpie::file
