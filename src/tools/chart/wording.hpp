// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::chart {

/// Text that is safe to show: broken UTF-8, control characters (a terminal would obey) and
/// characters that change the text direction become U+FFFD.
std::string safe_text(std::string_view text);

/// Length of UTF-8 text in code points.
std::size_t code_points(std::string_view text);

constexpr std::size_t kLongestName = 24;  ///< of an axis or a formula in a table or a legend

/// Printable text of at most `most` code points (≥ 1), with "…" at the end of cut text.
std::string shortened(std::string_view text, std::size_t most);

/// Names of files without their folders: "a.csv, b.csv" of "dives/a.csv, dives/b.csv". A path that
/// ends in "/" is that of a folder.
std::string file_names(std::string_view paths);

/// Printable text for HTML and SVG, in elements as well as in quoted attributes.
std::string escape_markup(std::string_view text);

/// "9,250", with a true minus sign for negative numbers.
std::string grouped(std::int64_t value);
template <std::integral Count>
std::string grouped(Count value) {
  return grouped(static_cast<std::int64_t>(value));
}

/// R² and the like: "0.951", "−0.204", from ±10 on three significant digits ("−1.5e+08");
/// "–" for NaN and infinities.
std::string decimal(double value);

/// Four significant digits: "0.5000", "−1.235e-06"; "–" for NaN and infinities.
std::string significant(double value);

/// A point in time in seconds to a hundredth, whatever its origin: "862.5", "1700001273.75"; "–"
/// for NaN and infinities.
std::string time_text(double time_s);

/// A time given in microseconds, in a suitable unit: "9.4 µs", "301 µs", "3.8 ms",
/// "1.2 s"; "–" for NaN and infinities.
std::string duration(double microseconds);

/// "a, b and c".
std::string list_text(const std::vector<std::string>& parts);

/// A unit as people write it: "m/s²" for "m s^-2", "N·m·s" for "N m s", "N/(rev/s)²" for
/// "N/(rev s^-1)^2"; other text as it is.
std::string unit_text(std::string_view unit);

}  // namespace kelpie::chart
