// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie {

/// Text without leading and trailing blanks, tabs and ends of lines.
std::string_view trimmed(std::string_view text);

/// The parts of `text` between separators, trimmed; "a,,b" has three, "" has one.
std::vector<std::string> split_text(std::string_view text, char separator);

/// The parts, joined by `separator`.
std::string join_text(std::span<const std::string> parts, std::string_view separator);

/// Number of insertions, deletions and replacements between two words, upper and lower case alike.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Text of others, as a message can quote: '?' in place of control characters, ends of lines and
/// bytes that are no UTF-8, and an ellipsis after the first `most` letters of a longer text.
std::string printable(std::string_view text, std::size_t most = 80);

/// The beginning and the end of a text of more than `most` bytes, with an ellipsis in place of what
/// lies between; a shorter text as it is.
std::string shortened(std::string_view text, std::size_t most = 1'200);

/// " (did you mean 'x'?)" for the candidate nearest to `word`; "" where more than a third of the
/// letters differ.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

/// "'fild' is no field (did you mean 'field'?); there are field, form": the reason of an error.
std::string unknown_name(std::string_view name, std::string_view kind,
                         std::span<const std::string> known);

/// The place of `name` among the known names. Throws InputError of `field` with unknown_name() on
/// another name.
std::size_t require_name(std::string_view field, std::string_view name, std::string_view kind,
                         std::span<const std::string> known);

/// A host without the brackets of an IPv6 address, as in "[::1]".
std::string without_brackets(const std::string& host);

/// The whole of `text` as a number. Returns false on other text ("1.5x", "", "1 2");
/// accepts "nan", "inf" and a leading '+', whatever the locale.
bool parse_number(std::string_view text, double& value);

/// A number in four significant digits, as in "0.125" or "2e-06".
std::string short_number(double value);

}  // namespace kelpie
