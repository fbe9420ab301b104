// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kelpie::file {

/// Throws InputError (file, line) on a key of more than 16 parts with dots between them: the parser
/// and its tables follow the parts of a key by recursion.
void check_toml_keys(std::string_view text, const std::string& file);

}  // namespace kelpie::file
