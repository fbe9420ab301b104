// SPDX-License-Identifier: Apache-2.0
#include "chart/text_table.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "chart/wording.hpp"
#include "core/text.hpp"

namespace kelpie::chart {
namespace {

using Line = std::vector<std::string>;

constexpr std::size_t kLongestCell = 36;
constexpr std::size_t kShortestWords = 8;

// Cells of fewer lines stand at the bottom.
std::vector<Line> head_lines(const Line& head) {
  std::vector<Line> lines;
  for (std::size_t column = 0; column < head.size(); ++column) {
    const Line parts = split_text(head[column], '\n');
    while (lines.size() < parts.size()) {
      lines.insert(lines.begin(), Line(head.size()));
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      lines[lines.size() - parts.size() + i][column] = parts[i];
    }
  }
  return lines;
}

std::vector<std::size_t> widths_of(const std::vector<Line>& lines) {
  std::vector<std::size_t> widths;
  for (const Line& line : lines) {
    widths.resize(std::max(widths.size(), line.size()), 0);
    for (std::size_t i = 0; i < line.size(); ++i) {
      widths[i] = std::max(widths[i], code_points(line[i]));
    }
  }
  return widths;
}

// One blank between columns where two are too many, then the widest words are cut. Returns the
// blanks.
std::size_t fit(std::vector<std::size_t>& widths, const std::vector<std::size_t>& left) {
  std::size_t used = std::accumulate(widths.begin(), widths.end(), widths.size());
  if (used + widths.size() <= kColumns) {
    return 2;
  }
  const auto width = [&](std::size_t column) { return widths.at(column); };
  for (; used > kColumns; --used) {
    std::size_t& widest = widths.at(std::ranges::max(left, {}, width));
    if (widest <= kShortestWords) {
      break;
    }
    --widest;
  }
  return 1;
}

}  // namespace

std::string tables_text(const std::vector<TextTable>& tables) {
  std::string text;
  for (const TextTable& table : tables) {
    text += table.rows.empty() ? "" : table_text(table);
  }
  return text;
}

std::string wrapped(std::string_view text, std::size_t columns) {
  std::string lines;
  std::size_t column = 0;
  for (const std::string& word : split_text(text, ' ')) {
    const std::size_t width = code_points(word);
    const bool fits = column > 0 && column + 1 + width <= columns;
    lines += (fits ? " " : column > 0 ? "\n" : "") + word;
    column = fits ? column + 1 + width : width;
  }
  return lines;
}

std::string table_text(const TextTable& table) {
  std::vector<Line> lines = head_lines(table.head);
  lines.insert(lines.end(), table.rows.begin(), table.rows.end());
  const std::size_t longest = table.whole ? std::numeric_limits<std::size_t>::max() : kLongestCell;
  for (Line& line : lines) {
    for (std::string& cell : line) {
      cell = shortened(cell, longest);
    }
  }
  std::vector<std::size_t> widths = widths_of(lines);
  const std::string gap(table.whole ? 2 : fit(widths, table.left), ' ');
  std::string text = table.title.empty() ? "" : wrapped(safe_text(table.title)) + "\n";
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string cell = shortened(line[i], widths[i]);
      const bool words = std::ranges::find(table.left, i) != table.left.end();
      const std::string blanks(widths[i] - code_points(cell), ' ');
      text += gap + (words ? cell + blanks : blanks + cell);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  for (const std::string& note : table.notes) {
    text += wrapped(safe_text(note)) + "\n";
  }
  return text + "\n";
}

}  // namespace kelpie::chart
