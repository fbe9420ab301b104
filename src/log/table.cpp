// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"
#include "log/csv_time.hpp"
#include "log/dataset.hpp"

namespace kelpie::log {
namespace {

[[noreturn]] void refuse_table(const Table& table, const std::string& field,
                               const std::string& message, std::size_t line = 0) {
  throw InputError({.file = table.source, .line = line, .field = field}, message);
}

}  // namespace

std::string columns_text(const Table& table) {
  constexpr std::size_t kShown = 200;
  const std::span<const std::string> names(table.names);
  const std::size_t more = names.size() - std::min(names.size(), kShown);
  return "the columns are " + join_text(names.first(names.size() - more), ", ") +
         (more > 0 ? fmt::format(" and {} more", more) : "");
}

std::size_t Table::find(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    refuse_table(*this, name,
                 fmt::format("there is no such column{}; {}", did_you_mean(name, names),
                             columns_text(*this)));
  }
  return static_cast<std::size_t>(found - names.begin());
}

bool Table::is_of_words(std::size_t column) const {
  if (!has_text(column)) {
    return false;
  }
  const auto numbers =
      std::ranges::count_if(columns[column], [](double x) { return std::isfinite(x); });
  return texts[column].words.size() > static_cast<std::size_t>(numbers);
}

void Table::require_numbers(std::size_t column) const {
  if (!has_text(column)) {
    return;
  }
  const Text& text = texts[column];
  std::string with_point = text.cell;
  std::ranges::replace(with_point, ',', '.');
  double number = 0.0;
  const bool decimal_comma = with_point != text.cell && parse_number(with_point, number);
  refuse_table(
      *this, names[column],
      is_unclear_stamp(text.cell)
          ? fmt::format("'{}' may have the day or the month first; write time stamps as "
                        "2023-05-01 12:00:00",
                        text.cell)
          : fmt::format("'{}' is not a number{}", text.cell,
                        decimal_comma ? fmt::format("; decimals take a point, as in {}", with_point)
                                      : " (or out of a double's range); leave a missing one "
                                        "empty, or write nan"),
      text.line);
}

double Table::seconds_per_unit(std::size_t column) const {
  constexpr std::array<std::pair<std::string_view, double>, 10> kSeconds{{{"", 1.0},
                                                                          {"s", 1.0},
                                                                          {"sec", 1.0},
                                                                          {"ms", 1e-3},
                                                                          {"us", 1e-6},
                                                                          {"µs", 1e-6},
                                                                          {"ns", 1e-9},
                                                                          {"min", 60.0},
                                                                          {"h", 3600.0},
                                                                          {"1", 1.0}}};
  const std::string_view unit = column < units.size() ? std::string_view(units[column]) : "";
  const auto* const found =
      std::ranges::find(kSeconds, unit, &decltype(kSeconds)::value_type::first);
  if (found == kSeconds.end()) {
    refuse_table(*this, names[column],
                 fmt::format("is in {}, which is no time; take s or ms", unit));
  }
  return found->second;
}

}  // namespace kelpie::log
