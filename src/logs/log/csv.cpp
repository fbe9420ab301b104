// SPDX-License-Identifier: Apache-2.0
#include "log/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/seconds.hpp"
#include "core/text.hpp"
#include "file/atomic_file.hpp"
#include "file/content.hpp"
#include "file/json.hpp"
#include "file/tuning.hpp"
#include "file/unpacked.hpp"
#include "kelpie/core/error.hpp"
#include "log/csv_time.hpp"
#include "log/known_roles.hpp"
#include "log/tuning.hpp"

namespace kelpie::log {
namespace {

constexpr std::size_t kShownLetters = 40;

// Throws InputError (file, line, column).
[[noreturn]] void refuse_csv(const std::string& source, std::size_t line,
                             const std::string& message, const std::string& field = {}) {
  throw InputError({.file = source, .line = line, .field = field}, message);
}

// The lines of a text, each without its end (LF, CRLF or CR), numbered from 1.
class Lines {
 public:
  Lines(std::string_view text, const std::string& source)
      : rest_(text), source_(source), is_cut_(!text.ends_with('\n') && !text.ends_with('\r')) {}

  bool next(std::string_view& line) {
    if (rest_.empty()) {
      return false;
    }
    const std::size_t length = std::min(rest_.find_first_of("\r\n"), rest_.size());
    if (length > kTuning.longest_line) {
      refuse_csv(source_, number_ + 1,
                 fmt::format("is a line of {} characters; at most {} are read", length,
                             kTuning.longest_line));
    }
    line = rest_.substr(0, length);
    rest_.remove_prefix(length);
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, rest_.size()));
    ++number_;
    return true;
  }

  std::size_t number() const { return number_; }
  // Whether the last line has no end.
  bool is_cut() const { return rest_.empty() && is_cut_; }

 private:
  std::string_view rest_;
  const std::string& source_;
  bool is_cut_;
  std::size_t number_ = 0;
};

constexpr std::string_view kBlanks = " \t";

// Cuts lines into cells. A separator ' ' stands for any number of blanks and tabs.
class CellCutter {
 public:
  CellCutter(std::string source, char separator)
      : source_(std::move(source)), separator_(separator) {}

  char separator() const { return separator_; }

  // The cells are views into the line, or into text kept here until the next call. Throws
  // InputError (file, line) on a broken quotation.
  std::span<const std::string_view> cut(std::string_view line, std::size_t number) {
    cells_.clear();
    unquoted_.clear();
    unquoted_.reserve(line.size());  // views into it have to stay valid
    line = separator_ == ' ' ? trimmed(line) : line;
    for (std::size_t first = 0; first <= line.size();) {
      first += separator_ == ' '
                   ? std::min(line.substr(first).find_first_not_of(kBlanks), line.size() - first)
                   : 0;
      const std::string_view rest = line.substr(first);
      const std::size_t start = rest.find_first_not_of(' ');
      if (start != std::string_view::npos && rest[start] == '"') {
        first += cut_quoted(rest, start, number);
      } else {
        const std::size_t length = end_of_cell(rest);
        cells_.push_back(trimmed(rest.substr(0, length)));
        first += length + 1;
      }
    }
    return cells_;
  }

 private:
  std::size_t end_of_cell(std::string_view rest) const {
    const std::size_t end = separator_ == ' ' ? rest.find_first_of(kBlanks) : rest.find(separator_);
    return std::min(end, rest.size());
  }

  // Returns the length of the cell with its separator.
  std::size_t cut_quoted(std::string_view rest, std::size_t quote, std::size_t number) {
    const std::size_t begin = unquoted_.size();
    std::size_t i = quote + 1;
    while (i < rest.size() && (rest[i] != '"' || rest.substr(i + 1).starts_with('"'))) {
      unquoted_ += rest[i];
      i += rest[i] == '"' ? 2 : 1;
    }
    if (i >= rest.size()) {
      refuse_csv(source_, number, "a quote is opened but not closed on this line");
    }
    const std::size_t after =
        separator_ == ' ' ? i + 1 : std::min(rest.find_first_not_of(' ', i + 1), rest.size());
    if (after < rest.size() && end_of_cell(rest.substr(after)) > 0) {
      refuse_csv(
          source_, number,
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

// Comma, semicolon or tab: the most frequent in the line, outside of quotes; without any the blank.
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
  const auto most = std::ranges::max_element(counts);
  return *most == 0 ? ' ' : kSeparators[static_cast<std::size_t>(most - counts.begin())];
}

struct NameAndUnit {
  std::string name;
  std::string unit;
};

bool is_unit(std::string_view text) {
  try {
    Unit::parse(text);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// Whether it is one of those that vehicles' logs have, by any of its spellings, or one that
// `--units` converts: of other words Unit knows that they could be.
bool is_known_unit(std::string_view text) {
  constexpr std::array<std::string_view, 24> kUnits{
      "m",   "s",   "ms", "us", "µs", "ns", "min", "h",   "rad", "N", "Nm", "rpm",
      "rps", "rev", "kg", "V",  "A",  "W",  "Pa",  "bar", "Hz",  "%", "J",  "K"};
  if (!is_unit(text)) {
    return false;
  }
  const Unit unit = Unit::parse(text);
  const bool is_one_name = text.find(' ') == std::string_view::npos;
  return text.find_first_of("/^*") != std::string_view::npos ||
         std::ranges::find(kUnits, unit.text()) != kUnits.end() ||
         (is_one_name && unit.in_si().first != unit);
}

// "u [m/s]" as u and m/s; what has no unit behind it as it is.
NameAndUnit name_and_unit(std::string_view cell) {
  constexpr std::array<std::pair<char, char>, 2> kBrackets{{{'[', ']'}, {'(', ')'}}};
  for (const auto& [open, close] : kBrackets) {
    const std::size_t at = cell.rfind(open);
    if (at == std::string_view::npos || at == 0 || !cell.ends_with(close)) {
      continue;
    }
    const std::string_view unit = trimmed(cell.substr(at + 1, cell.size() - at - 2));
    const std::string_view name = trimmed(cell.substr(0, at));
    if (!name.empty() && (unit == "-" || is_known_unit(unit))) {
      return {std::string(name), unit == "-" ? "1" : std::string(unit)};
    }
  }
  return {std::string(cell), ""};
}

// Of a column that begins with a time but goes on otherwise, that is what is wrong with it.
void read_stamps(Table& table, std::size_t column) {
  Table::Text& text = table.texts[column];
  std::vector<double>& values = table.columns[column];
  std::vector<std::int64_t> times_ns = times_of_words(text.words);
  const bool has_numbers =
      std::ranges::any_of(values, [](double value) { return std::isfinite(value); });
  if (times_ns.size() < text.words.size() || has_numbers) {
    if (!times_ns.empty() && !has_numbers) {
      const auto& [row, word] = text.words[times_ns.size()];
      text.line = table.lines[row];
      text.cell = printable(word, kShownLetters);
    }
    return;
  }
  for (std::size_t k = 0; k < times_ns.size(); ++k) {
    values[text.words[k].first] = seconds(times_ns[k] - times_ns.front());
  }
  table.units[column] = "s";
  text = {.line = 0, .cell = {}, .words = {}, .is_time = true};
}

bool numbers_rows(const std::vector<double>& values) {
  double before = -1.0;
  return std::ranges::all_of(values, [&](double value) {
    return value > std::exchange(before, value) && value == std::trunc(value);
  });
}

void finish_first_column(Table& table, std::size_t header_line) {
  if (table.texts.front().is_time) {
    const auto is_free = [&](const char* name) {
      return std::ranges::find(table.names, name) == table.names.end();
    };
    table.names.front() = is_free("time") ? "time" : "time of the row";
    return;
  }
  if (table.has_text(0) || !numbers_rows(table.columns.front()) || table.names.size() == 1) {
    refuse_csv(table.source, header_line,
               "has no name in the header; every column needs one, but a first one that numbers "
               "the rows or holds time stamps",
               "column 1");
  }
  table.names.erase(table.names.begin());
  table.columns.erase(table.columns.begin());
  table.texts.erase(table.texts.begin());
  table.units.erase(table.units.begin());
}

// Takes the column names from the header: "u [m/s]" or "u (m/s)" is the column u with this unit if
// no other column has the name. The first column may lack a name until finish_columns().
void name_columns(Table& table, std::span<const std::string_view> cells, std::size_t line) {
  if (cells.size() > kTuning.most_columns) {
    refuse_csv(table.source, line,
               fmt::format("{} columns; at most {} are read", cells.size(), kTuning.most_columns));
  }
  std::multiset<std::string> short_names;
  for (const std::string_view cell : cells) {
    short_names.insert(name_and_unit(cell).name);
  }
  std::set<std::string> seen;
  for (std::size_t column = 0; column < cells.size(); ++column) {
    const std::string whole(cells[column]);
    const std::string place = fmt::format("column {}", column + 1);
    if (!file::is_utf8(whole)) {
      refuse_csv(table.source, line, "the column's name is not UTF-8; save the log as UTF-8",
                 place);
    }
    if (whole.empty() && (column > 0 || cells.size() == 1)) {
      refuse_csv(table.source, line, "has no name in the header; every column needs one", place);
    }
    if (!seen.insert(whole).second) {
      refuse_csv(table.source, line, "two columns have this name; rename one",
                 printable(whole, kShownLetters));
    }
    NameAndUnit known = name_and_unit(whole);
    if (short_names.count(known.name) > 1) {
      known = {whole, ""};
    }
    if (known.unit.empty()) {
      known.unit = unit_in_name(known.name);
    }
    table.names.push_back(std::move(known.name));
    table.units.push_back(std::move(known.unit));
  }
  table.columns.resize(cells.size());
  table.texts.resize(cells.size());
}

// Takes the row below the header as units: no numbers, each cell a unit, "-" or empty, and one unit
// known. Returns whether the row was one of units.
bool take_units(Table& table, std::span<const std::string_view> cells) {
  const bool fits =
      cells.size() == table.names.size() && std::ranges::any_of(cells, is_known_unit) &&
      std::ranges::all_of(cells, [](std::string_view cell) {
        double number = 0.0;
        return cell.empty() || cell == "-" || (!parse_number(cell, number) && is_unit(cell));
      });
  for (std::size_t column = 0; fits && column < cells.size(); ++column) {
    if (!cells[column].empty()) {
      table.units[column] = cells[column] == "-" ? "1" : std::string(cells[column]);
    }
  }
  return fits;
}

// After the last row: columns of time stamps become s since the first stamp; a first column without
// a name is dropped if it numbers the rows (as pandas writes), and called "time" if it holds
// stamps.
void finish_columns(Table& table, std::size_t header_line) {
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (table.has_text(column)) {
      read_stamps(table, column);
    }
  }
  if (table.names.front().empty()) {
    finish_first_column(table, header_line);
  }
}

constexpr const char* kRecover = "; --recover reads what stands before";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

void check_is_text(std::string_view content, const std::string& source) {
  constexpr std::array<std::pair<std::string_view, const char*>, 10> kOthers{
      {{"\xFF\xFE", "is UTF-16; save it as UTF-8"},
       {"\xFE\xFF", "is UTF-16; save it as UTF-8"},
       {"PK\x03\x04", "is a spreadsheet or a zip file; save the table as CSV"},
       {"\xFF\xD8\xFF", "is a picture (JPEG), no log"},
       {"\x89PNG", "is a picture (PNG), no log"},
       {"%PDF", "is a document (PDF); save the table as CSV"},
       {"<!", "is HTML or XML, as a page saved from the web; save the table as CSV"},
       {"<html", "is HTML, as a page saved from the web; save the table as CSV"},
       {"<?xml", "is XML; save the table as CSV"},
       {"{", "is JSON, no table; a model of `kelpie learn` is taken by --model or --from"}}};
  for (const auto& [beginning, what] : kOthers) {
    if (content.starts_with(beginning)) {
      refuse_csv(source, 0, what);
    }
  }
  if (const std::size_t nul = content.find('\0'); nul != std::string_view::npos) {
    if (content.find_first_not_of('\0', nul) == std::string_view::npos) {
      refuse_csv(source, 0,
                 fmt::format("ends in {} NUL bytes, as after a loss of power{}",
                             content.size() - nul, kRecover));
    }
    const auto line = 1 + std::ranges::count(content.substr(0, nul), '\n');
    refuse_csv(source, static_cast<std::size_t>(line),
               "holds a NUL byte: binary or UTF-16? Save it as text in UTF-8");
  }
}

// Puts a table together, line by line.
class TableBuilder {
 public:
  TableBuilder(const std::string& source, std::string* losses)
      : losses_(losses), cutter_(source, ',') {
    table_.source = source;
  }

  // `is_last`: nothing ends the line.
  void add(std::string_view line, std::size_t number, bool is_last) {
    is_last_ = is_last;
    const std::string_view content = trimmed(line);
    const bool is_comment =
        content.starts_with('#') || content.starts_with("% ") || content.starts_with("%%");
    if (content.empty() || is_comment) {
      if (is_comment && header_.text.empty()) {
        const std::size_t marks = content.find_first_not_of("#%");
        comment_ = {std::string(content.substr(std::min(marks, content.size()))), number};
      }
      return;
    }
    if (content.size() == 5 && content.starts_with("sep=") && header_.text.empty()) {  // by Excel
      cutter_ = CellCutter(table_.source, content.back());
      has_separator_ = true;
      return;
    }
    if (header_.text.empty() && !take_comment(line, number)) {
      header_ = {std::string(line), number};
      return;
    }
    if (table_.names.empty()) {
      take_header(line);
    }
    const std::span<const std::string_view> cells = cutter_.cut(line, number);
    if (table_.rows() == 0 && !has_units_row_ && take_units(table_, cells)) {
      has_units_row_ = true;
    } else {
      add_row(cells, line, number);
    }
  }

  Table finished() {
    if (header_.text.empty()) {
      refuse_csv(table_.source, 0,
                 "is empty; a header line that names the columns and rows of numbers are due");
    }
    if (table_.names.empty()) {
      take_header("");
    }
    if (table_.rows() == 0) {
      refuse_csv(table_.source, 0, "has a header but no rows");
    }
    finish_columns(table_, header_.number);
    return std::move(table_);
  }

 private:
  struct Line {
    std::string text;
    std::size_t number = 0;
  };

  static bool is_number(std::string_view cell) {
    double number = 0.0;
    return parse_number(cell, number);
  }

  // The first line that is no comment may be a row below a comment with the names, as
  // numpy.savetxt() writes it.
  bool take_comment(std::string_view line, std::size_t number) {
    if (!has_separator_) {
      cutter_ = CellCutter(table_.source, separator_of(line));
    }
    const std::span<const std::string_view> cells = cutter_.cut(line, number);
    const std::size_t count = cells.size();
    if (std::ranges::none_of(cells, is_number)) {
      return false;
    }
    const bool is_row = std::ranges::all_of(cells, is_number);
    const bool has_names = !comment_.text.empty() && comment_.text.find('"') == std::string::npos;
    for (const char separator : {cutter_.separator(), separator_of(comment_.text)}) {
      if (!has_names) {
        break;
      }
      CellCutter names(table_.source, separator);
      const std::span<const std::string_view> found = names.cut(comment_.text, comment_.number);
      if (found.size() == count && std::ranges::none_of(found, is_number)) {
        header_ = comment_;
        name_columns(table_, found, header_.number);
        return true;
      }
    }
    if (is_row) {
      refuse_csv(table_.source, number,
                 "the first line holds only numbers; it has to name the columns, as in u,v,r" +
                     (comment_.text.empty()
                          ? std::string()
                          : fmt::format(", or as many as the row has cells ({}) in the comment "
                                        "above",
                                        count)));
    }
    return false;
  }

  // A header of words without a separator names one column, unless the row below has as many cells
  // as the header has words.
  void take_header(std::string_view row) {
    if (!has_separator_) {
      cutter_ = CellCutter(table_.source, separator_of(header_.text));
    }
    if (cutter_.separator() == ' ') {
      const std::size_t words = cutter_.cut(header_.text, header_.number).size();
      const char own = separator_of(row);
      if (own != ' ' || words < 2 || cutter_.cut(row, header_.number + 1).size() != words) {
        cutter_ = CellCutter(table_.source, ',');
      }
    }
    std::span<const std::string_view> names = cutter_.cut(header_.text, header_.number);
    const bool ends_alike = !row.empty() && trimmed(row).back() == cutter_.separator();
    if (names.size() > 2 && names.back().empty() && ends_alike &&
        leaves_out(header_.number, "ends in an empty column")) {
      names = names.first(names.size() - 1);
    }
    name_columns(table_, names, header_.number);
  }

  // What is wrong with a row of another number of cells than the header, as far as it shows.
  std::string wrong_count_text(std::span<const std::string_view> cells, std::string_view line) {
    const std::size_t names = table_.names.size();
    const char own = cutter_.separator();
    const auto are_digits = [](std::string_view cell) {
      return cell.find_first_not_of("+-0123456789eE") == std::string_view::npos;
    };
    if (const char other = separator_of(line);
        other != own && names > 1 &&
        static_cast<std::size_t>(std::ranges::count(line, other)) + 1 == names) {
      return fmt::format(": they are separated by '{}', those of the header by '{}'", other, own);
    }
    if (is_last_ && cells.size() < names) {
      return std::string(": the file ends within this line") + kRecover;
    }
    return own == ',' && 2 * cells.size() > 3 * names && std::ranges::all_of(cells, are_digits)
               ? ": decimal commas? Separate cells by ';', or write decimals with a point"
               : "";
  }

  void add_row(std::span<const std::string_view> cells, std::string_view text, std::size_t line) {
    const std::size_t names = table_.names.size();
    if (text == header_.text && leaves_out(line, "is the header again")) {
      return;
    }
    if (text == header_.text) {
      refuse_csv(table_.source, line,
                 "is the header again: two logs in one file? Give them one by one");
    }
    if (losses_ != nullptr && cells.size() == names + 1 && cells.back().empty()) {
      cells = cells.first(names);
    }
    if (is_last_ && cells.size() < names && leaves_out(line, "is cut off")) {
      return;
    }
    if (cells.size() != names) {
      const std::size_t count = cells.size();
      refuse_csv(table_.source, line,
                 fmt::format("{} cells in this row; the header has {}{}", count,
                             table_.names.size(), wrong_count_text(cells, text)));
    }
    for (std::size_t column = 0; column < cells.size(); ++column) {
      double value = 0.0;
      if (!parse_cell(cells[column], column, line, value)) {
        value = std::numeric_limits<double>::quiet_NaN();
        if (!cells[column].empty()) {
          if (++words_ > kTuning.most_words) {
            refuse_csv(table_.source, line,
                       fmt::format("more than {} cells up to here hold no numbers; leave such "
                                   "columns out",
                                   kTuning.most_words),
                       table_.names[column]);
          }
          if (!table_.has_text(column)) {
            table_.texts[column].line = line;
            table_.texts[column].cell = printable(cells[column], kShownLetters);
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

  // Notes the line as lost where losses are allowed.
  bool leaves_out(std::size_t line, const char* why) {
    if (losses_ != nullptr) {
      *losses_ += fmt::format("{}:{}: {}; left out\n", table_.source, line, why);
    }
    return losses_ != nullptr;
  }

  void note_mark(std::size_t& own_line, std::string_view cell, std::size_t column,
                 std::size_t line) {
    own_line = line;
    if (comma_line_ > 0 && point_line_ > 0) {
      refuse_csv(table_.source, line,
                 fmt::format("'{}': decimals have a comma on line {} and a point on line {}; write "
                             "all of them alike, and nothing between thousands",
                             printable(cell, kShownLetters), comma_line_, point_line_),
                 table_.names[column]);
    }
  }

  Table table_;
  std::string* losses_;
  bool is_last_ = false;
  CellCutter cutter_;
  bool has_separator_ = false;
  bool has_units_row_ = false;
  Line header_;
  Line comment_;  // the last one above the header
  std::size_t words_ = 0;
  std::size_t comma_line_ = 0;  // where the first decimal comma and point stand; 0: nowhere
  std::size_t point_line_ = 0;
};

std::string quoted_if_needed(std::string_view text) {
  if (text.find_first_of(",;\t\"#% ") == std::string_view::npos) {
    return std::string(text);
  }
  std::string quoted = "\"";
  for (const char letter : text) {
    quoted.append(letter == '"' ? 2 : 1, letter);
  }
  return quoted + '"';
}

}  // namespace

Table read_csv(const std::filesystem::path& file, std::string* losses) {
  return parse_csv(file::read_content(file, "a CSV file", file::kTuning.table_bytes), file.string(),
                   losses);
}

Table parse_csv(std::string content, const std::string& source, std::string* losses) {
  content = file::unpacked(std::move(content), source);
  if (const std::size_t end = content.find_last_not_of('\0') + 1;
      losses != nullptr && end < content.size()) {
    *losses += fmt::format("{}: {} NUL bytes at the end; left out\n", source, content.size() - end);
    content.resize(end);
  }
  check_is_text(content, source);
  std::string_view text = content;
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  TableBuilder builder(source, losses);
  Lines lines(text, source);
  for (std::string_view line; lines.next(line);) {
    builder.add(line, lines.number(), lines.is_cut());
  }
  return builder.finished();
}

std::string csv_text(const Table& table) {
  fmt::memory_buffer text;
  std::vector<std::size_t> passed(table.columns.size(), 0);  // of each column's words
  const auto word_at = [&](std::size_t column, std::size_t row) -> const std::string* {
    if (!table.has_text(column)) {
      return nullptr;
    }
    const auto& words = table.texts[column].words;
    const bool is_next = passed[column] < words.size() && words[passed[column]].first == row;
    return is_next ? &words[passed[column]++].second : nullptr;
  };
  const auto out = std::back_inserter(text);
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    fmt::format_to(out, "{}{}", column > 0 ? "," : "", quoted_if_needed(table.names[column]));
  }
  text.push_back('\n');
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      fmt::format_to(out, "{}", column > 0 ? "," : "");
      if (const std::string* const word = word_at(column, row)) {
        fmt::format_to(out, "{}", quoted_if_needed(*word));
      } else {
        fmt::format_to(out, "{}", table.columns[column][row]);
      }
    }
    text.push_back('\n');
  }
  return {text.data(), text.size()};
}

void write_csv(const std::filesystem::path& file, const Table& table) {
  file::write_file_whole(file, csv_text(table));
}

}  // namespace kelpie::log
