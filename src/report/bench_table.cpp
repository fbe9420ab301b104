// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "bench_views.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/report/bench_report.hpp"
#include "kelpie/report/wording.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kLongestCell = 36;

std::string padded(const std::string& cell, std::size_t width, bool left) {
  const std::string text = shortened(cell, kLongestCell);
  const std::string blanks(width - code_points(text), ' ');
  return left ? text + blanks : blanks + text;
}

std::string wrapped(const std::string& text) {
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

}  // namespace

std::string bench_table(const BenchResult& result) {
  std::string text = wrapped(bench_method(result)) + "\n\n";
  for (const TextTable& table : bench_tables(result)) {
    text += table_text(table);
  }
  return text;
}

std::string soak_table(const std::vector<SoakRun>& runs) {
  std::string text;
  for (const SoakRun& run : runs) {
    text += fmt::format(
        "{}: {} updates, {} fallbacks, largest gap {:.1e} (allowed {:.0e}), "
        "median {}, max {}: {}\n",
        run.storage == Storage::float64 ? "double" : "float",
        grouped(static_cast<std::int64_t>(run.updates)), run.fallbacks, run.gap, run.gap_allowed,
        duration(run.median_us), duration(run.max_us), run.good() ? "good" : "NOT GOOD");
  }
  return text;
}

}  // namespace kelpie
