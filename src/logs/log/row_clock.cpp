// SPDX-License-Identifier: Apache-2.0
#include "log/row_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bag/stamp_unit.hpp"
#include "core/text.hpp"
#include "log/csv_time.hpp"
#include "log/known_roles.hpp"
#include "log/tuning.hpp"

namespace kelpie::log {
namespace {

constexpr const auto& kClock = kTuning.clock;
constexpr double kInfiniteRows = std::numeric_limits<double>::infinity();

std::string known_name(const Table& table, std::size_t column) {
  return join_text(words_of(table.names[column]), "_");
}

// The column by any known name or by time stamps; "" for none.
std::string time_by_name(const Table& table) {
  std::string found;
  std::size_t best = std::numeric_limits<std::size_t>::max();
  const auto try_name = [&](std::size_t column, const std::string& name, const auto& names,
                            std::size_t first) {
    const auto place = std::ranges::find(names, name) - std::ranges::begin(names);
    const std::size_t rank = first + static_cast<std::size_t>(place);
    if (static_cast<std::size_t>(place) < std::ranges::size(names) && rank < best) {
      best = rank;
      found = table.names[column];
    }
  };
  const std::size_t words = kTimeNames.size();
  const std::size_t others = 2 * words;
  const std::size_t stamps = others + known_times().size();
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (table.is_of_words(column)) {
      continue;
    }
    try_name(column, table.names[column], kTimeNames, 0);
    try_name(column, known_name(table, column), kTimeNames, words);
    try_name(column, known_name(table, column), known_times(), others);
    if (table.is_time(column) && stamps < best) {
      best = stamps;
      found = table.names[column];
    }
  }
  return found;
}

std::vector<double> finite_values(const Table& table, std::size_t column) {
  std::vector<double> values;
  std::ranges::copy_if(table.columns[column], std::back_inserter(values),
                       [](double value) { return std::isfinite(value); });
  return values;
}

// Of the velocity that changes most; empty where no velocity is known.
std::optional<double> velocity_memory_rows(const Table& table) {
  std::optional<double> least;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (const std::vector<double> values = finite_values(table, column);
        !values.empty() && velocity_by_name(table.names[column])) {
      least = std::min(least.value_or(kInfiniteRows), memory_rows(values));
    }
  }
  return least;
}

// The unit of stamps that count as s, and are not likely to be: in this unit the log has the rate
// of usual logs, and its velocities the memory of a vehicle's.
std::string likely_unit(const Table& table, double step_s) {
  const std::optional<double> rows = velocity_memory_rows(table);
  for (const auto& [unit, seconds] :
       {std::pair("ms", 1e-3), std::pair("us", 1e-6), std::pair("ns", 1e-9)}) {
    if (step_s * seconds <= kClock.longest_step_s &&
        (!rows || *rows * step_s * seconds <= kClock.longest_memory_s)) {
      return unit;
    }
  }
  return "";
}

// Whole numbers, of which velocities as slow as of no vehicle tell that they are hardly s.
bool are_hardly_seconds(const Table& table, const std::vector<double>& times, double step_s) {
  const bool are_whole =
      std::ranges::all_of(times, [](double time) { return time == std::floor(time); });
  return are_whole && times.back() < kClock.since_1970_s &&
         velocity_memory_rows(table).value_or(0.0) * step_s > kClock.longest_memory_s;
}

std::string rate_problem(const Table& table, std::size_t column, RowClock& clock) {
  std::vector<double> times = finite_values(table, column);
  const double unit_s = table.seconds_per_unit(column);
  const double mean_step_s =
      times.size() < 2 ? 0.0 : unit_s * (times.back() - times.front()) / double(times.size() - 1);
  const double rate = mean_step_s > 0.0 ? 1.0 / mean_step_s : 0.0;
  const bool is_given = column < table.units.size() && !table.units[column].empty();
  const bool may_be_other = !is_given && mean_step_s >= kClock.least_whole_step_s;
  clock.unit = may_be_other ? likely_unit(table, mean_step_s) : "";
  const std::string remedy =
      clock.unit.empty()
          ? ""
          : fmt::format(": --units {0}={1} says that it is in {1}", clock.column, clock.unit);
  if (rate < kClock.slowest_hz || rate > kClock.fastest_hz) {
    return fmt::format("the column {} gives {:.3g} rows per second, which is hardly in s{}",
                       clock.column, rate, rate < 1.0 ? remedy : "");
  }
  if (!clock.unit.empty() && are_hardly_seconds(table, times, mean_step_s)) {
    return fmt::format(
        "the column {} counts whole numbers, in s one row each {:.3g} s, in which velocities "
        "hardly change{}; --units {}=s that it is in s",
        clock.column, mean_step_s, remedy, clock.column);
  }
  return "";
}

// Of a log of several runs: how often its time begins anew within the first second of the first.
std::size_t starts_anew(const std::vector<double>& times) {
  constexpr double kNear = 1.0;
  std::size_t starts = 0;
  std::optional<double> before;
  double first = std::numeric_limits<double>::infinity();
  for (const double now : times) {
    if (std::isfinite(now)) {
      first = std::min(first, before ? first : now);
      starts += before && now < *before - kNear && std::abs(now - first) <= kNear ? 1 : 0;
      before = now;
    }
  }
  return starts;
}

// Whether the values go up and down, as those of no clock and of no rows in reverse.
bool goes_up_and_down(const std::vector<double>& times) {
  constexpr double kShare = 0.1;  // by hand
  double up = 0.0;
  double down = 0.0;
  for (std::size_t row = 1; row < times.size(); ++row) {
    up += times[row] > times[row - 1] ? 1.0 : 0.0;
    down += times[row] < times[row - 1] ? 1.0 : 0.0;
  }
  return std::min(up, down) > kShare * (up + down);
}

std::string order_text(const std::vector<double>& times, double back_s) {
  struct KnownStep {
    double seconds;
    const char* what;
  };
  constexpr std::array<KnownStep, 3> kSteps{
      {{86'400.0, "a midnight? Add 86400 s to the rows after it"},
       {604'800.0, "a new week of GPS? Add 604800 s to the rows after it"},
       {3'600.0, "an hour, as at the end of summer time? Write times in UTC"}}};
  for (const auto& [seconds, what] : kSteps) {
    if (std::abs(back_s - seconds) < kClock.near_step_s) {
      return what;
    }
  }
  if (const std::size_t starts = starts_anew(times); starts > 1) {
    return fmt::format(
        "time begins anew {} times: give each run a file of its own, `kelpie learn "
        "run1.csv run2.csv …`, or the rows per second by --rate",
        starts);
  }
  return std::string("rows have to be in the order of time") +
         (goes_up_and_down(times) ? "; is this a column of time? --time names another" : "");
}

}  // namespace

double memory_rows(const std::vector<double>& values) {
  double mean = 0.0;
  std::ranges::for_each(values, [&](double value) { mean += value / double(values.size()); });
  const auto product = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t row = lag; row < values.size(); ++row) {
      sum += (values[row] - mean) * (values[row - lag] - mean);
    }
    return sum / static_cast<double>(std::max<std::size_t>(values.size() - lag, 1));
  };
  const double half = 0.5 * product(0);
  std::size_t lag = 1;
  while (lag < values.size() && product(lag) > half) {
    lag *= 2;
  }
  if (lag >= values.size() || half <= 0.0) {
    return static_cast<double>(std::min(lag, values.size()));
  }
  const double before = product(lag / 2);
  const auto first = static_cast<double>(lag / 2);
  return first + (static_cast<double>(lag) - first) * (before - half) / (before - product(lag));
}

std::string time_order_problem(const Table& table, std::size_t column, double most_s,
                               std::size_t& line) {
  const std::vector<double>& times = table.columns[column];
  const double unit_s = table.seconds_per_unit(column);
  std::optional<std::size_t> before;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!std::isfinite(times[row])) {
      continue;
    }
    const double back_s = before ? unit_s * (times[*before] - times[row]) : 0.0;
    if (back_s > most_s) {
      line = table.lines[row];
      return fmt::format("time runs backwards, from {} (line {}) to {} {}; {}", times[*before],
                         table.lines[*before], times[row],
                         unit_s == 1.0 ? "s" : table.units[column], order_text(times, back_s));
    }
    before = row;
  }
  return "";
}

std::string unread_time_text(const Table& table) {
  for (std::size_t column = 0; column < table.texts.size(); ++column) {
    const std::string& cell = table.texts[column].cell;
    if (is_unclear_stamp(cell)) {
      return fmt::format(
          "; {} holds '{}', which may have the day or the month first: write time "
          "stamps as 2023-05-01 12:00:00",
          table.names[column], cell);
    }
    const std::string name = known_name(table, column);
    if (table.is_of_words(column) &&
        (std::ranges::count(kTimeNames, name) > 0 || std::ranges::count(known_times(), name) > 0)) {
      return fmt::format(
          "; {} holds '{}' (line {}): times are read in s, as 2023-05-01 12:00:00, "
          "13:07:00.2 or 0.2 sec",
          table.names[column], cell, table.texts[column].line);
    }
  }
  return "";
}

namespace {

// Why the column does not tell the times of rows; "": it does.
std::string column_problem(const Table& table, std::size_t column, RowClock& clock) {
  if (table.is_of_words(column)) {
    const Table::Text& text = table.texts[column];
    return fmt::format("{} holds '{}' (line {}), which is no time", clock.column, text.cell,
                       text.line);
  }
  std::size_t line = 0;
  const std::string problem = time_order_problem(table, column, kClock.longest_step_back_s, line);
  return problem.empty() ? rate_problem(table, column, clock)
                         : fmt::format("{} (line {}): {}", clock.column, line, problem);
}

}  // namespace

RowClock row_clock(const Table& table, const Roles& given) {
  RowClock clock{.column = given.time.empty() ? time_by_name(table) : given.time,
                 .rate_hz = given.rate_hz};
  if (clock.column.empty()) {
    clock.problem = "no column is named t, time, stamp or the like" + unread_time_text(table) +
                    "; accelerations take one: --time names the column, or --rate gives the rows "
                    "per second";
  } else {
    clock.problem = column_problem(table, table.find(clock.column), clock);
  }
  if (clock.rate_hz > 0.0 && !clock.problem.empty()) {
    return {.rate_hz = clock.rate_hz};
  }
  clock.problem = clock.problem.empty() ? "" : "time: " + clock.problem;
  return clock;
}

std::vector<double> row_times_s(const Table& table, const std::string& time, double rate_hz,
                                bool with_words) {
  std::vector<double> times_s(table.rows());
  if (time.empty()) {
    for (std::size_t row = 0; row < times_s.size(); ++row) {
      times_s[row] = static_cast<double>(row) / rate_hz;
    }
    return times_s;
  }
  const std::size_t column = table.find(time);
  if (!with_words) {
    table.require_numbers(column);
  }
  const double unit_s = table.seconds_per_unit(column);
  std::ranges::transform(table.columns[column], times_s.begin(),
                         [&](double value) { return unit_s * value; });
  return times_s;
}

std::string settle_time_unit(Table& table, const Roles& given) {
  const std::string name = given.time.empty() ? time_by_name(table) : given.time;
  const auto found = std::ranges::find(table.names, name);
  if (name.empty() || found == table.names.end() || given.units.contains(name)) {
    return "";
  }
  const auto column = static_cast<std::size_t>(found - table.names.begin());
  table.units.resize(table.names.size());
  const std::vector<double> times = finite_values(table, column);
  if (!table.units[column].empty() || times.size() < 2) {
    return "";
  }
  const auto by_size = bag::unit_by_size(times.front(), times.back(), times.size() - 1);
  const auto by_name = bag::unit_in_name(known_name(table, column));
  const auto unit = by_size ? by_size : by_name;
  if (!unit || unit->name == "s") {
    return "";
  }
  table.units[column] = unit->name;
  return fmt::format("{}: {}: read in {}, as its {} tells; --units {}=s takes it in s\n",
                     table.source, name, unit->name, by_size ? "size" : "name", name);
}

}  // namespace kelpie::log
