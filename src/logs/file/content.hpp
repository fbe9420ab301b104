// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace kelpie::file {

/// Content of a regular file or of a pipe, at most `most_bytes`; `wanted` names the content in
/// messages ("a CSV file"). Reads a pipe to the end; after 5 s of silence a line on stderr tells
/// that the program waits. Throws InputError (file): missing or unreadable file, folder, device,
/// more bytes; Failure: an error of the disk, a signal with a handler during the wait.
std::string read_content(const std::filesystem::path& file, const std::string& wanted,
                         std::size_t most_bytes);

/// The first bytes of a regular file, at most `most_bytes`; "" for anything else: looking into a
/// pipe would consume the content.
std::string beginning_of(const std::filesystem::path& file, std::size_t most_bytes);

/// A size in millions of bytes, to a tenth: "256 MB", "13.2 MB".
std::string megabytes(std::size_t bytes);

}  // namespace kelpie::file
