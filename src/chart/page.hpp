// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chart/figure.hpp"
#include "chart/text_table.hpp"

namespace kelpie::chart {

// What pages of results are made of. Text is escaped here, HTML is taken as it is.

/// A part of a page, with a heading, and a link to it in the page's table of contents.
struct Section {
  std::string title;
  std::string body;  ///< empty: the section is left out
};

/// A whole page that needs nothing else and is kept from asking for it: no network. Style, chart
/// library and figure.js are in it. `opening` comes first, with a table of contents after it.
std::string html_page(const std::string& title, const std::string& opening,
                      const std::vector<Section>& sections);

/// A page that a running program shows: `script` comes after figure.js, and may ask the program
/// itself for more, nobody else.
std::string live_page(const std::string& title, const std::string& body, std::string_view script);

/// <h1> to <h3>, of names that come from a log, too.
std::string heading(int level, std::string_view text);

std::string paragraph(std::string_view css_class, const std::string& text);

/// Several figures, side by side where there is room.
std::string panels(const std::vector<std::string>& figures);

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Names beside their values.
std::string facts_table(const Facts& facts);

/// A table with a head; the first cell of each row is its name. "\n" in a cell begins a new line.
std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows,
                       std::string_view css_class = "");

/// The same with its notes below; nothing where there are no rows.
std::string html_table(const TextTable& table);

/// Several of them, each under its title.
std::string html_tables(const std::vector<TextTable>& tables);

}  // namespace kelpie::chart
