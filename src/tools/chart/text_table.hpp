// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::chart {

/// A head and rows, for a terminal or a page alike. The first cell of a row is its name.
struct TextTable {
  std::string title;              ///< may be empty
  std::vector<std::string> head;  ///< on a terminal, "\n" in a cell begins a new line
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> notes{};  ///< lines below, on a terminal
  std::vector<std::size_t> left{0};  ///< columns of words; number columns end at the right
  bool whole = false;                ///< no cell is cut, at any width
};

/// For a terminal: title, head, rows, notes and an empty line at the end. Columns are as wide as
/// their text. Unless `whole`, long cells are cut, and words further in lines above 100 columns.
std::string table_text(const TextTable& table);

/// Tables with rows, one after the other.
std::string tables_text(const std::vector<TextTable>& tables);

constexpr std::size_t kColumns = 100;  ///< of a terminal's text

/// Words in lines of at most so many columns.
std::string wrapped(std::string_view text, std::size_t columns = kColumns);

}  // namespace kelpie::chart
