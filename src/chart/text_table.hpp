// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kelpie::chart {

/// A head and rows, for a terminal or a page alike. The first cell of a row is its name.
struct TextTable {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// For a terminal: title, head and rows in columns as wide as their text, long cells cut, and an
/// empty line at the end.
std::string table_text(const TextTable& table);

/// Words in lines of at most 100 columns.
std::string wrapped(std::string_view text);

}  // namespace kelpie::chart
