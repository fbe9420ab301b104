// SPDX-License-Identifier: Apache-2.0
#include "report/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "chart/wording.hpp"
#include "report/coefficient_tables.hpp"
#include "report/coverage_table.hpp"
#include "study/summary.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kShortestName = 8;
constexpr std::size_t kLongestName = 24;

enum class Paint : std::uint8_t { plain, bold, red };

struct Cell {
  std::string text;
  Paint paint = Paint::plain;
};

using Row = std::vector<Cell>;

std::string painted(const std::string& text, Paint paint, bool colour) {
  if (!colour || paint == Paint::plain || text.empty()) {
    return text;
  }
  return (paint == Paint::bold ? "\x1b[1m" : "\x1b[31m") + text + "\x1b[0m";
}

std::string count(std::int64_t value) {
  constexpr std::int64_t kMillion = 1'000'000;
  return value < kMillion ? fmt::format("{}", value)
                          : fmt::format("{:.3g}M", static_cast<double>(value) / kMillion);
}

std::string microseconds(double value) {
  if (!std::isfinite(value)) {
    return chart::decimal(value);
  }
  return value < 1e6 ? fmt::format("{:.{}f}", value, value < 10.0 ? 1 : 0)
                     : fmt::format("{:.1e}", value);
}

std::string gap(double value) {
  return std::isfinite(value) ? fmt::format("{:.0e}", value) : chart::decimal(value);
}

// A model gone astray can be at −10⁸; such digits say nothing and would push the table apart.
Cell r2_cell(double value) {
  return {value < -999.0 ? "<−999" : chart::decimal(value),
          value < 0.0 ? Paint::red : Paint::plain};
}

Row head_row(const std::vector<std::string>& words) {
  Row row;
  for (const std::string& word : words) {
    row.push_back({word, Paint::bold});
  }
  return row;
}

std::vector<Row> rows_of(const study::StreamResult& result) {
  std::vector<Row> rows = {
      head_row({"", "R²", "R²", "min", "one", "", "median", "p99", "KKT", "", "turned", "", ""}),
      head_row({"axis", "final", "mean", "≥1000", "ahead", "SVs", "µs", "µs", "gap", "accepted",
                "away", "outliers", "forgotten"})};
  for (const study::AxisResult& axis : result.axes) {
    const study::Quantiles times = study::quantiles_of(axis.update_us);
    const Status& status = axis.status;
    rows.push_back({{chart::printable(axis.name)},
                    r2_cell(axis.r2_final),
                    r2_cell(axis.r2_mean),
                    r2_cell(axis.r2_min_after_1000),
                    r2_cell(axis.prequential_r2),
                    {count(status.support_vectors)},
                    {microseconds(times.median)},
                    {microseconds(times.p99)},
                    {gap(study::served_gap(status))},
                    {count(status.tally.accepted)},
                    {count(study::turned_away(status.tally))},
                    {count(status.tally.outliers)},
                    {count(status.tally.forgotten)}});
  }
  return rows;
}

std::vector<std::size_t> widths_of(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], chart::code_points(row[i].text));
    }
  }
  return widths;
}

// Two blanks between columns, or one where two would cost too much of the names.
std::size_t separation(std::vector<std::size_t>& widths) {
  std::size_t numbers = 0;
  for (std::size_t i = 1; i < widths.size(); ++i) {
    numbers += widths[i];
  }
  const std::size_t gaps = widths.size() - 1;
  const bool roomy = numbers + 2 * gaps + std::min(widths[0], kShortestName) <= kColumns;
  const std::size_t blanks = roomy ? 2 : 1;
  const std::size_t used = std::min(numbers + blanks * gaps, kColumns - 1);
  widths[0] = std::min(widths[0], kColumns - used);
  return blanks;
}

// What only a budget or a solver in trouble brings about: rare, so a line instead of columns.
std::string trouble(const study::AxisResult& axis) {
  const Tally& tally = axis.status.tally;
  std::string text;
  for (const TallyField& field : study::totals_by_kind()) {
    const bool rare = field.kind == TallyKind::trouble || field.total == &Tally::crowded_out;
    if (const std::int64_t number = tally.*field.total; rare && number > 0) {
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count(number), field.label);
    }
  }
  return text.empty() ? "" : chart::shortened(axis.name, kLongestName) + ": " + text + "\n";
}

std::string changes(const study::AxisResult& axis) {
  std::string text;
  for (const study::ChangeFound& change : axis.changes) {
    text += fmt::format(
        "{}: {}, found after {} samples at {:.6g} s (errors grew from {:.6g} s)\n",
        chart::shortened(axis.name, kLongestName),
        change.recalled > 0 ? fmt::format("the vehicle of past model {} is back", change.recalled)
                            : "the vehicle has changed",
        count(static_cast<std::int64_t>(change.samples)), change.time_s, change.since_s);
  }
  return text;
}

std::string coefficients(const study::StreamResult& result) {
  std::string text;
  for (const chart::TextTable& table : coefficient_tables(result)) {
    text += chart::table_text(table);
  }
  return text.empty() ? "" : "\n" + text + chart::wrapped(kCoefficientNote) + "\n";
}

std::string intervals(const study::StreamResult& result) {
  const chart::TextTable table = coverage_table(result);
  return table.rows.empty()
             ? ""
             : "\n" + chart::table_text(table) + chart::wrapped(kCoverageNote) + "\n";
}

std::string headline(const study::StreamResult& result, bool colour) {
  const auto rows = [](std::size_t n) { return chart::grouped(static_cast<std::int64_t>(n)); };
  std::string text =
      chart::shortened(result.source, kColumns) + "\n" +
      chart::shortened("split: " + result.split, kColumns) + "\n" +
      fmt::format("{} rows read, {} skipped; {} for training, {} held out; {} shown\n",
                  rows(result.rows_read), rows(result.rows_skipped), rows(result.training_rows),
                  rows(result.held_out_rows), rows(result.samples_shown));
  if (result.interrupted) {
    text += painted(fmt::format("INTERRUPTED after {} of {} training samples",
                                rows(result.samples_shown), rows(result.training_rows)),
                    Paint::red, colour) +
            "\n";
  }
  return text;
}

}  // namespace

std::string result_table(const study::StreamResult& result, bool colour) {
  const std::vector<Row> rows = rows_of(result);
  std::vector<std::size_t> widths = widths_of(rows);
  const std::size_t blanks = separation(widths);
  std::string text = headline(result, colour) + "\n";
  for (const Row& row : rows) {
    const std::string name = chart::shortened(row[0].text, widths[0]);
    text += painted(name, row[0].paint, colour) +
            std::string(widths[0] - chart::code_points(name), ' ');
    for (std::size_t i = 1; i < row.size(); ++i) {
      text += std::string(blanks + widths[i] - chart::code_points(row[i].text), ' ') +
              painted(row[i].text, row[i].paint, colour);
    }
    text += "\n";
  }
  for (const study::AxisResult& axis : result.axes) {
    text += trouble(axis) + changes(axis);
  }
  if (result.memory_bytes > 0) {
    text += fmt::format("memory: {} for {} ax{}s\n", chart::megabytes(result.memory_bytes),
                        result.axes.size(), result.axes.size() == 1 ? "i" : "e");
  }
  return text + intervals(result) + coefficients(result);
}

}  // namespace kelpie::report
