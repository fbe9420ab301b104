// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chart/figure.hpp"

namespace kelpie::chart {

// What pages of results are made of. Text is escaped here, SVG and HTML are taken as they are.

/// A whole page that needs nothing else: no network, no script.
std::string html_page(const std::string& title, const std::string& body);

std::string paragraph(std::string_view css_class, const std::string& text);

std::string figure_of(const Panel& panel);

/// Two drawings of one figure: scaling the wide one to a phone would make its text too small.
std::string figure_of(const Panel& wide, const Panel& narrow);

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Names beside their values.
std::string facts_table(const Facts& facts);

/// A table with a head; the first cell of each row is its name. "\n" in a cell begins a new line.
std::string html_table(const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& rows,
                       std::string_view css_class = "");

}  // namespace kelpie::chart
