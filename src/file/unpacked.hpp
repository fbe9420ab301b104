// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kelpie::file {

/// What a file holds that gzip or zstd has packed, told by its first bytes; any other content as it
/// is. `source` is what messages call it.
/// Throws InputError (file): damaged or cut-off content, something else behind it, and what unpacks
/// to more than 256 MB and a hundred times its size, as no log does.
std::string unpacked(std::string content, const std::string& source);

}  // namespace kelpie::file
