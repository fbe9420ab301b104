// SPDX-License-Identifier: Apache-2.0
#include "chart/text_table.hpp"

#include <algorithm>

#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::chart {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kLongestCell = 36;

std::string padded(const std::string& cell, std::size_t width, bool left) {
  const std::string text = shortened(cell, kLongestCell);
  const std::string blanks(width - code_points(text), ' ');
  return left ? text + blanks : blanks + text;
}

}  // namespace

std::string wrapped(std::string_view text) {
  std::string lines;
  std::size_t column = 0;
  for (const std::string& word : split_text(text, ' ')) {
    const std::size_t width = code_points(word);
    const bool fits = column > 0 && column + 1 + width <= kColumns;
    lines += (fits ? " " : column > 0 ? "\n" : "") + word;
    column = fits ? column + 1 + width : width;
  }
  return lines;
}

std::string table_text(const TextTable& table) {
  std::vector<std::vector<std::string>> lines{table.head};
  lines.insert(lines.end(), table.rows.begin(), table.rows.end());
  std::vector<std::size_t> widths(table.head.size(), 0);
  for (const std::vector<std::string>& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      widths[i] = std::max(widths[i], std::min(kLongestCell, code_points(line[i])));
    }
  }
  std::string text = printable(table.title) + "\n";
  for (const std::vector<std::string>& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      text += "  " + padded(line[i], widths[i], i == 0);
    }
    text += "\n";
  }
  return text + "\n";
}

}  // namespace kelpie::chart
