// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kelpie::log {

/// Parses an ISO 8601 time stamp to ns since 1970: "2023-05-01 12:00:00.123456+00:00", with a blank
/// or T; time of day, seconds, fraction (to the ns) and zone are optional; the default zone is UTC.
/// Returns empty for any other text, and outside of 1970 to 2200.
std::optional<std::int64_t> parse_stamp(std::string_view text);

/// The times of a column's words (row and word, in order) in ns, all of one form: time stamps of
/// ISO 8601; days with the name of a month (01-May-2023, 1 May 2023); days in numbers where a
/// number beyond 12 in some row tells the day from the month; times of day, where each step back of
/// half a day is a midnight; durations (0.2 sec, 3 min, 1 days 00:00:01). Times of day may have AM
/// or PM. Ends before the first word of another form; empty for words that are no times, and for
/// days that may be months.
std::vector<std::int64_t> times_of_words(
    std::span<const std::pair<std::size_t, std::string>> words);

/// Whether the text begins as a date with ambiguous day and month: "01.05.2023 12:00".
bool is_unclear_stamp(std::string_view text);

}  // namespace kelpie::log
