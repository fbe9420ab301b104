// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <string>

namespace kelpie {

/// As std::to_chars; digits behind the point, or in all for `general`.
std::string text_of(double value, int digits, std::chars_format form = std::chars_format::fixed);

}  // namespace kelpie
