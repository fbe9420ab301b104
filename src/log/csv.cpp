// SPDX-License-Identifier: Apache-2.0
#include "log/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "file/unpacked.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"
#include "log/csv_cells.hpp"
#include "log/csv_columns.hpp"

namespace kelpie::log {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

void check_is_text(std::string_view content, const std::string& source) {
  if (content.starts_with("\xFF\xFE") || content.starts_with("\xFE\xFF")) {
    refuse_csv(source, 0, "is UTF-16; save it as UTF-8");
  }
  if (const std::size_t nul = content.find('\0'); nul != std::string_view::npos) {
    const auto line = 1 + std::ranges::count(content.substr(0, nul), '\n');
    refuse_csv(source, static_cast<std::size_t>(line),
               "holds a NUL byte: binary or UTF-16? Save it as text in UTF-8");
  }
}

// Puts a table together, line by line.
class TableBuilder {
 public:
  explicit TableBuilder(const std::string& source) : cutter_(source, ',') {
    table_.source = source;
  }

  void add(std::string_view line, std::size_t number) {
    const std::string_view content = trimmed(line);
    if (content.empty() || content.starts_with('#')) {
      return;
    }
    if (!has_separator_) {
      has_separator_ = true;
      const bool is_named = content.size() == 5 && content.starts_with("sep=");  // by Excel
      cutter_ = CellCutter(table_.source, is_named ? content.back() : separator_of(line));
      if (is_named) {
        return;
      }
    }
    const std::span<const std::string_view> cells = cutter_.cut(line, number);
    if (table_.names.empty()) {
      name_columns(table_, cells, number);
      header_line_ = number;
    } else if (table_.rows() > 0 || has_units_row_ ||
               !(has_units_row_ = take_units(table_, cells))) {
      add_row(cells, number);
    }
  }

  Table finished() {
    if (table_.names.empty()) {
      refuse_csv(table_.source, 0,
                 "is empty; a header line that names the columns and rows of numbers are due");
    }
    if (table_.rows() == 0) {
      refuse_csv(table_.source, 0, "has a header but no rows");
    }
    finish_columns(table_, header_line_);
    return std::move(table_);
  }

 private:
  void add_row(std::span<const std::string_view> cells, std::size_t line) {
    if (cells.size() != table_.names.size()) {
      refuse_csv(table_.source, line,
                 fmt::format("{} cells in this row; the header has {}", cells.size(),
                             table_.names.size()));
    }
    for (std::size_t column = 0; column < cells.size(); ++column) {
      double value = 0.0;
      if (!parse_cell(cells[column], column, line, value)) {
        value = std::numeric_limits<double>::quiet_NaN();
        if (!cells[column].empty()) {
          if (!table_.has_text(column)) {
            table_.texts[column].line = line;
            table_.texts[column].cell = shown_cell(cells[column]);
          }
          table_.texts[column].words.emplace_back(table_.rows(), cells[column]);
        }
      }
      table_.columns[column].push_back(value);
    }
    table_.lines.push_back(line);
  }

  // A decimal comma where commas don't separate cells; but not both marks in one file.
  bool parse_cell(std::string_view cell, std::size_t column, std::size_t line, double& value) {
    const bool may_be_comma = cutter_.separator() != ',';
    if (parse_number(cell, value)) {
      if (may_be_comma && point_line_ == 0 && cell.find('.') != std::string_view::npos) {
        note_mark(point_line_, cell, column, line);
      }
      return true;
    }
    const std::size_t comma = cell.find(',');
    if (!may_be_comma || comma == std::string_view::npos) {
      return false;
    }
    std::string with_point(cell);
    with_point[comma] = '.';
    if (!parse_number(with_point, value)) {
      return false;
    }
    if (comma_line_ == 0) {
      note_mark(comma_line_, cell, column, line);
    }
    return true;
  }

  void note_mark(std::size_t& own_line, std::string_view cell, std::size_t column,
                 std::size_t line) {
    own_line = line;
    if (comma_line_ > 0 && point_line_ > 0) {
      refuse_csv(table_.source, line,
                 fmt::format("'{}': decimals have a comma on line {} and a point on line {}; write "
                             "all of them alike, and nothing between thousands",
                             shown_cell(cell), comma_line_, point_line_),
                 table_.names[column]);
    }
  }

  Table table_;
  CellCutter cutter_;
  bool has_separator_ = false;
  bool has_units_row_ = false;
  std::size_t header_line_ = 0;
  std::size_t comma_line_ = 0;  // where the first decimal comma and point stand; 0: nowhere
  std::size_t point_line_ = 0;
};

Table parse_csv(std::string_view content, const std::string& source) {
  check_is_text(content, source);
  if (content.starts_with(kByteOrderMark)) {
    content.remove_prefix(kByteOrderMark.size());
  }
  TableBuilder builder(source);
  Lines lines(content);
  for (std::string_view line; lines.next(line);) {
    builder.add(line, lines.number());
  }
  return builder.finished();
}

}  // namespace

Table read_csv(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    refuse_csv(file.string(), 0, "is a folder; a CSV file is needed");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream.is_open()) {
    refuse_csv(file.string(), 0, "cannot be read: " + std::generic_category().message(errno));
  }
  return read_csv(stream, file.string());
}

Table read_csv(std::istream& stream, const std::string& source) {
  constexpr std::size_t kChunk = 1U << 20U;
  std::string content;
  while (stream) {
    const std::size_t size = content.size();
    content.resize(size + kChunk);
    stream.read(content.data() + size, kChunk);
    content.resize(size + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) {
    throw Failure(source + ": reading failed");
  }
  return parse_csv(file::unpacked(std::move(content), source), source);
}

}  // namespace kelpie::log
