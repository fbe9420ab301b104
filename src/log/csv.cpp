// SPDX-License-Identifier: Apache-2.0
#include "log/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <limits>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "file/json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::log {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kShownBytes = 40;

[[noreturn]] void refuse(const std::string& source, std::size_t line, const std::string& message,
                         const std::string& field = {}) {
  throw InputError({.file = source, .line = line, .field = field}, message);
}

// What of a cell a message can show: short, and nothing that would steer a terminal.
std::string shown(std::string_view cell) {
  std::size_t length = std::min(cell.size(), kShownBytes);
  const auto continues_letter = [&](std::size_t i) {  // in UTF-8
    return i < cell.size() && (static_cast<unsigned char>(cell[i]) & 0xC0U) == 0x80U;
  };
  while (length > 0 && continues_letter(length)) {
    --length;
  }
  std::string text(cell.substr(0, length));
  std::ranges::replace_if(
      text, [](unsigned char letter) { return letter < ' ' || letter == '\x7F'; }, '?');
  return text + (length < cell.size() ? "…" : "");
}

// The lines of a text, each without its end (LF, CRLF or CR), numbered from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool next(std::string_view& line) {
    if (rest_.empty()) {
      return false;
    }
    const std::size_t length = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line = rest_.substr(0, length);
    rest_.remove_prefix(length);
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, rest_.size()));
    ++number_;
    return true;
  }

  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

// Cuts lines into cells.
class CellCutter {
 public:
  CellCutter(std::string source, char separator)
      : source_(std::move(source)), separator_(separator) {}

  // The cells are views into the line, or into text kept here until the next call.
  std::span<const std::string_view> cut(std::string_view line, std::size_t number) {
    cells_.clear();
    unquoted_.clear();
    unquoted_.reserve(line.size());  // views into it have to stay valid
    for (std::size_t first = 0; first <= line.size();) {
      const std::string_view rest = line.substr(first);
      const std::size_t start = rest.find_first_not_of(' ');
      if (start != std::string_view::npos && rest[start] == '"') {
        first += cut_quoted(rest, start, number);
      } else {
        const std::size_t length = std::min(rest.find(separator_), rest.size());
        cells_.push_back(trimmed(rest.substr(0, length)));
        first += length + 1;
      }
    }
    return cells_;
  }

 private:
  // Returns the length of the cell with its separator.
  std::size_t cut_quoted(std::string_view rest, std::size_t quote, std::size_t number) {
    const std::size_t begin = unquoted_.size();
    std::size_t i = quote + 1;
    while (i < rest.size() && (rest[i] != '"' || rest.substr(i + 1).starts_with('"'))) {
      unquoted_ += rest[i];
      i += rest[i] == '"' ? 2 : 1;
    }
    if (i >= rest.size()) {
      refuse(source_, number, "a quote is opened but not closed on this line");
    }
    const std::size_t after = std::min(rest.find_first_not_of(' ', i + 1), rest.size());
    if (after < rest.size() && rest[after] != separator_) {
      refuse(source_, number,
             fmt::format("after a closing quote the next '{}' is due; a quote within a quoted cell "
                         "is written twice",
                         separator_));
    }
    cells_.push_back(trimmed(std::string_view(unquoted_).substr(begin)));
    return after + 1;
  }

  std::string source_;
  char separator_;
  std::vector<std::string_view> cells_;
  std::string unquoted_;
};

char separator_of(std::string_view header) {
  constexpr std::array<char, 3> kSeparators{',', ';', '\t'};
  std::array<std::size_t, kSeparators.size()> counts{};
  bool in_quotes = false;
  for (const char letter : header) {
    in_quotes = in_quotes != (letter == '"');
    for (std::size_t k = 0; k < kSeparators.size() && !in_quotes; ++k) {
      counts[k] += letter == kSeparators[k] ? 1 : 0;
    }
  }
  return kSeparators[static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin())];
}

void check_header(const Table& table, std::size_t line) {
  double number = 0.0;
  if (std::ranges::all_of(table.names,
                          [&](const auto& name) { return parse_number(name, number); })) {
    refuse(table.source, line,
           "the first line holds only numbers; it has to name the columns, as in u,v,r");
  }
  std::set<std::string_view> seen;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    const std::string& name = table.names[column];
    if (!file::is_utf8(name)) {
      refuse(table.source, line, "the column's name is not UTF-8; save the log as UTF-8",
             fmt::format("column {}", column + 1));
    }
    if (name.empty()) {
      refuse(table.source, line, "has no name in the header; every column needs one",
             fmt::format("column {}", column + 1));
    }
    if (!seen.insert(name).second) {
      refuse(table.source, line, "two columns have this name; rename one", shown(name));
    }
  }
}

void start_table(Table& table, std::span<const std::string_view> names, std::size_t line) {
  table.names.assign(names.begin(), names.end());
  check_header(table, line);
  table.columns.resize(names.size());
  table.texts.resize(names.size());
}

void add_row(Table& table, std::span<const std::string_view> cells, std::size_t line) {
  if (cells.size() != table.names.size()) {
    refuse(
        table.source, line,
        fmt::format("{} cells in this row; the header has {}", cells.size(), table.names.size()));
  }
  for (std::size_t column = 0; column < cells.size(); ++column) {
    double value = 0.0;
    if (!parse_number(cells[column], value)) {
      value = std::numeric_limits<double>::quiet_NaN();
      if (!cells[column].empty()) {
        if (!table.has_text(column)) {
          table.texts[column] = {line, shown(cells[column])};
        }
        table.texts[column].words.emplace_back(table.rows(), cells[column]);
      }
    }
    table.columns[column].push_back(value);
  }
  table.lines.push_back(line);
}

void check_is_text(std::string_view content, const std::string& source) {
  if (content.starts_with("\xFF\xFE") || content.starts_with("\xFE\xFF")) {
    refuse(source, 0, "is UTF-16; save it as UTF-8");
  }
  if (const std::size_t nul = content.find('\0'); nul != std::string_view::npos) {
    const auto line = 1 + std::ranges::count(content.substr(0, nul), '\n');
    refuse(source, static_cast<std::size_t>(line),
           "holds a NUL byte: binary or UTF-16? Save it as text in UTF-8");
  }
}

Table parse_csv(std::string_view content, const std::string& source) {
  check_is_text(content, source);
  if (content.starts_with(kByteOrderMark)) {
    content.remove_prefix(kByteOrderMark.size());
  }
  Table table;
  table.source = source;
  CellCutter cutter(source, ',');
  Lines lines(content);
  for (std::string_view line; lines.next(line);) {
    if (trimmed(line).empty() || trimmed(line).starts_with('#')) {
      continue;
    }
    if (table.names.empty()) {
      cutter = CellCutter(source, separator_of(line));
      start_table(table, cutter.cut(line, lines.number()), lines.number());
    } else {
      add_row(table, cutter.cut(line, lines.number()), lines.number());
    }
  }
  if (table.names.empty()) {
    refuse(source, 0, "is empty; a header line that names the columns and rows of numbers are due");
  }
  if (table.rows() == 0) {
    refuse(source, 0, "has a header but no rows");
  }
  return table;
}

}  // namespace

Table read_csv(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    refuse(file.string(), 0, "is a folder; a CSV file is needed");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream.is_open()) {
    refuse(file.string(), 0, "cannot be read: " + std::generic_category().message(errno));
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
  return parse_csv(content, source);
}

}  // namespace kelpie::log
