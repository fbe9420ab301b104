// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chart/figure.hpp"
#include "chart/text_table.hpp"

namespace kelpie::chart {

// Parts of pages. Text is escaped here; HTML is inserted unchanged.

/// A part of a page, with a heading and a link in the table of contents.
struct Section {
  std::string title;
  std::string body;     ///< empty: the section is left out
  bool folded = false;  ///< shown after a click; such sections come last
};

/// A self-contained page with style, chart library and figure.js; its Content-Security-Policy
/// forbids the network. `opening` comes first, then the table of contents: a link for each section,
/// one for the folded ones together.
std::string html_page(const std::string& title, const std::string& opening,
                      const std::vector<Section>& sections);

/// A page served by a running program: `script` comes after figure.js and may request more data
/// from the same program alone.
std::string live_page(const std::string& title, const std::string& body, std::string_view script);

/// <h1> to <h3>; also for names from a log.
std::string heading(int level, std::string_view text);

std::string paragraph(std::string_view css_class, const std::string& text);

/// Several figures, side by side where there is room.
std::string panels(const std::vector<std::string>& figures);

/// Two parts side by side; on a phone the right part follows the left.
std::string columns(const std::string& left, const std::string& right);

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Names beside their values.
std::string facts_table(const Facts& facts);

/// Commands to copy, each with its purpose.
std::string command_lines(const Facts& commands);

/// HTML behind a line that unfolds the HTML.
std::string folded(const std::string& summary, const std::string& html);

/// A table with a head; the first cell of each row is its name. "\n" in a cell begins a new line.
/// Columns of numbers end at the right, those of words in `left` begin at the left.
std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows,
                       std::string_view css_class = "", std::span<const std::size_t> left = {});

/// A value with its interval, for interval_table().
struct IntervalRow {
  std::string name;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  std::string text;  ///< value and unit
  std::string note;  ///< may be empty
};

/// Each value with its interval as a bar, on a scale from 0 to twice the value: how sure a value is
/// shows at once, whatever its unit. Bars beyond the scale are cut at its ends.
std::string interval_table(const std::vector<IntervalRow>& rows);

/// A table with its notes below; empty without rows.
std::string html_table(const TextTable& table);

/// Several tables, each under its title.
std::string html_tables(const std::vector<TextTable>& tables);

}  // namespace kelpie::chart
