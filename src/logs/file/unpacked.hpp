// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kelpie::file {

/// The unpacked content of a gzip or zstd file, recognised by the first bytes; any other content
/// unchanged. Messages call the content `source`. Throws InputError (file): damaged or cut-off
/// content, trailing bytes, an unpacked size above 1 GB, or above 32 MB and a hundred times the
/// packed size, which no log reaches.
std::string unpacked(std::string content, const std::string& source);

}  // namespace kelpie::file
