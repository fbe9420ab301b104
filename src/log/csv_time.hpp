// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace kelpie::log {

/// An ISO 8601 time stamp in ns since 1970: "2023-05-01 12:00:00.123456+00:00", with a blank or T,
/// with or without seconds, their fraction (to the ns), time of day, and zone (none, Z, UTC: UTC).
/// None: it isn't one, or lies outside of 1970 to 2200.
std::optional<std::int64_t> parse_stamp(std::string_view text);

/// Whether it begins as a date whose first number may be day or month: "01.05.2023 12:00".
bool is_unclear_stamp(std::string_view text);

}  // namespace kelpie::log
