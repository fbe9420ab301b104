// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace kelpie::log {

/// Parses an ISO 8601 time stamp to ns since 1970: "2023-05-01 12:00:00.123456+00:00", with a blank
/// or T; time of day, seconds, fraction (to the ns) and zone are optional; the default zone is UTC.
/// Returns empty for any other text, and outside of 1970 to 2200.
std::optional<std::int64_t> parse_stamp(std::string_view text);

/// Whether the text begins as a date with ambiguous day and month: "01.05.2023 12:00".
bool is_unclear_stamp(std::string_view text);

}  // namespace kelpie::log
