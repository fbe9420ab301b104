// SPDX-License-Identifier: Apache-2.0
#include "log/csv_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "file/json.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/seconds.hpp"
#include "kelpie/core/text.hpp"
#include "log/csv_cells.hpp"
#include "log/csv_time.hpp"

namespace kelpie::log {
namespace {

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

// Whether it is one of those that vehicles' logs have: of other words Unit knows that they could
// be.
bool is_known_unit(std::string_view text) {
  constexpr std::array<std::string_view, 28> kUnits{
      "m", "mm", "cm",  "km",  "s",  "ms", "us", "µs", "ns", "min", "h",  "rad", "deg", "°",
      "N", "Nm", "rpm", "rev", "kg", "V",  "A",  "W",  "Pa", "bar", "Hz", "%",   "J",   "K"};
  return std::ranges::find(kUnits, text) != kUnits.end() ||
         (text.find_first_of("/^*") != std::string_view::npos && is_unit(text));
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

bool are_stamps(const Table::Text& text, std::vector<std::int64_t>& times_ns, Table::Text& other) {
  for (const auto& [row, word] : text.words) {
    const std::optional<std::int64_t> time_ns = parse_stamp(word);
    if (!time_ns) {
      other.cell = shown_cell(word);
      other.line = row;
      return false;
    }
    times_ns.push_back(*time_ns);
  }
  return !times_ns.empty();
}

// Of a column that begins with a stamp but goes on otherwise, that is what is wrong with it.
void read_stamps(Table& table, std::size_t column) {
  Table::Text& text = table.texts[column];
  std::vector<double>& values = table.columns[column];
  std::vector<std::int64_t> times_ns;
  Table::Text other;
  const bool has_numbers =
      std::ranges::any_of(values, [](double value) { return std::isfinite(value); });
  if (!are_stamps(text, times_ns, other) || has_numbers) {
    if (!times_ns.empty() && !other.cell.empty()) {
      text.line = table.lines[other.line];
      text.cell = other.cell;
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

}  // namespace

void name_columns(Table& table, std::span<const std::string_view> cells, std::size_t line) {
  double number = 0.0;
  if (std::ranges::all_of(cells, [&](auto cell) { return parse_number(cell, number); })) {
    refuse_csv(table.source, line,
               "the first line holds only numbers; it has to name the columns, as in u,v,r");
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
      refuse_csv(table.source, line, "two columns have this name; rename one", shown_cell(whole));
    }
    NameAndUnit known = name_and_unit(whole);
    const bool is_clear = short_names.count(known.name) == 1;
    table.names.push_back(is_clear ? std::move(known.name) : whole);
    table.units.push_back(is_clear ? std::move(known.unit) : "");
  }
  table.columns.resize(cells.size());
  table.texts.resize(cells.size());
}

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

}  // namespace kelpie::log
