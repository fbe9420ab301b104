// SPDX-License-Identifier: Apache-2.0
#include "kelpie/data/csv.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/data/atomic_file.hpp"

namespace kelpie {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kShownLetters = 40;

// The lines of a text, each without its end (LF, CRLF or CR), numbered from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool next(std::string_view& line) {
    if (rest_.empty()) {
      return false;
    }
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line = rest_.substr(0, end);
    const bool both = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(end + (both ? 2 : 1), rest_.size()));
    ++number_;
    return true;
  }

  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

// Cuts a line into cells. A quoted cell may hold the separator, and quotes doubled.
class CellReader {
 public:
  CellReader(std::string source, char separator)
      : source_(std::move(source)), separator_(separator) {}

  // Views into the line, or into texts kept here until the next call.
  const std::vector<std::string_view>& read(std::string_view line, std::size_t number) {
    cells_.clear();
    unquoted_.clear();
    unquoted_.reserve(line.size());  // so that views into it stay valid
    for (std::size_t first = 0; first <= line.size();) {
      const std::string_view rest = line.substr(first);
      const std::size_t quote = rest.find_first_not_of(" ");
      if (quote != std::string_view::npos && rest[quote] == '"') {
        first += quoted(rest, quote, number);
      } else {
        const std::size_t end = std::min(rest.find(separator_), rest.size());
        cells_.push_back(trimmed(rest.substr(0, end)));
        first += end + 1;
      }
    }
    return cells_;
  }

 private:
  std::size_t quoted(std::string_view rest, std::size_t quote, std::size_t number) {
    const std::size_t begin = unquoted_.size();
    std::size_t i = quote + 1;
    while (i < rest.size() && (rest[i] != '"' || rest.substr(i).starts_with("\"\""))) {
      unquoted_ += rest[i];
      i += rest[i] == '"' ? 2 : 1;
    }
    const std::size_t after = rest.find_first_not_of(' ', i + 1);
    if (i == rest.size() || (after < rest.size() && rest[after] != separator_)) {
      throw InputError({.file = source_, .line = number, .field = {}},
                       "a quoted cell has to end with a quote before the next separator");
    }
    cells_.push_back(std::string_view(unquoted_).substr(begin));
    return std::min(after, rest.size()) + 1;
  }

  std::string source_;
  char separator_;
  std::vector<std::string_view> cells_;
  std::string unquoted_;
};

char separator_of(std::string_view header) {
  constexpr std::array<char, 3> kSeparators{',', ';', '\t'};
  return *std::ranges::max_element(
      kSeparators, {}, [&](char separator) { return std::ranges::count(header, separator); });
}

void check_header(const Table& table, std::size_t line) {
  const auto refuse = [&](const std::string& field, const std::string& message) {
    throw InputError({.file = table.source, .line = line, .field = field}, message);
  };
  double number = 0.0;
  if (std::ranges::all_of(table.names,
                          [&](const auto& name) { return parse_number(name, number); })) {
    refuse("header", "there are only numbers; the first line has to name the columns");
  }
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (table.names[i].empty()) {
      refuse("column " + std::to_string(i + 1), "has no name");
    }
    if (std::find(table.names.begin(), table.names.begin() + static_cast<std::ptrdiff_t>(i),
                  table.names[i]) != table.names.begin() + static_cast<std::ptrdiff_t>(i)) {
      refuse(table.names[i], "there are two columns of this name; rename one");
    }
  }
}

void add_row(Table& table, const std::vector<std::string_view>& cells, std::size_t line) {
  if (cells.size() != table.names.size()) {
    throw InputError({.file = table.source, .line = line, .field = {}},
                     std::to_string(cells.size()) + " cells; the header has " +
                         std::to_string(table.names.size()));
  }
  for (std::size_t column = 0; column < cells.size(); ++column) {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!cells[column].empty() && !parse_number(cells[column], value)) {
      value = std::numeric_limits<double>::quiet_NaN();
      if (table.texts[column].line == 0) {
        table.texts[column] = {line, std::string(cells[column].substr(0, kShownLetters))};
      }
    }
    table.columns[column].push_back(value);
  }
  table.lines.push_back(line);
}

Table parse_csv(std::string_view text, const std::string& source) {
  const auto refuse = [&](std::size_t line, const std::string& message) {
    throw InputError({.file = source, .line = line, .field = {}}, message);
  };
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
      text.substr(0, kShownLetters).find('\0') != std::string_view::npos) {
    refuse(0, "is not plain text (UTF-16 or binary?); save it as UTF-8");
  }
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  Table table;
  table.source = source;
  Lines lines(text);
  std::string_view line;
  CellReader reader(source, ',');
  while (lines.next(line)) {
    if (trimmed(line).empty() || trimmed(line).front() == '#') {
      continue;
    }
    if (table.names.empty()) {
      reader = CellReader(source, separator_of(line));
      const auto& names = reader.read(line, lines.number());
      table.names.assign(names.begin(), names.end());
      check_header(table, lines.number());
      table.columns.resize(table.names.size());
      table.texts.resize(table.names.size());
    } else {
      add_row(table, reader.read(line, lines.number()), lines.number());
    }
  }
  if (table.names.empty()) {
    refuse(0, "is empty; a header line with the names of the columns is needed");
  }
  if (table.rows() == 0) {
    refuse(0, "has a header, but no rows");
  }
  return table;
}

std::string quoted_name(const std::string& name) {
  if (name.find_first_of(",;\t\"# ") == std::string::npos) {
    return name;
  }
  std::string quoted = "\"";
  for (const char letter : name) {
    quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  }
  return quoted + '"';
}

}  // namespace

Table read_csv(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream.is_open() || std::filesystem::is_directory(file)) {
    throw InputError({.file = file.string(), .line = 0, .field = {}},
                     std::filesystem::exists(file) ? "cannot be read; a CSV file is needed"
                                                   : "there is no such file");
  }
  return read_csv(stream, file.string());
}

Table read_csv(std::istream& stream, const std::string& source) {
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) {
    throw Failure(source + ": reading failed");
  }
  return parse_csv(text, source);
}

void write_csv(const std::filesystem::path& file, const Table& table) {
  std::string text;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    text += (column > 0 ? "," : "") + quoted_name(table.names[column]);
  }
  text += '\n';
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      text += (column > 0 ? "," : "") + number_text(table.columns[column][row]);
    }
    text += '\n';
  }
  write_file_whole(file, text);
}

}  // namespace kelpie
