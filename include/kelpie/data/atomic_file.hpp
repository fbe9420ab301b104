// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace kelpie {

/// Writes `content` to a file beside `file`, syncs it and renames it over `file`, so that a reader
/// sees the old content or the new, never a part. Throws Failure naming the file and the system's
/// reason; nothing is left behind then.
void write_file_whole(const std::filesystem::path& file, std::string_view content);

/// The same for several files of one folder (made if missing): all are written beside their places
/// before the first is renamed, so that a full disk leaves the old set untouched.
void write_files_whole(const std::filesystem::path& folder,
                       const std::map<std::string, std::string>& content_by_name);

}  // namespace kelpie
