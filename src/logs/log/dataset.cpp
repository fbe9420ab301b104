// SPDX-License-Identifier: Apache-2.0
#include "log/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "core/quantile.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/csv_time.hpp"
#include "log/known_roles.hpp"
#include "log/row_clock.hpp"
#include "motion/signal_names.hpp"

namespace kelpie::log {
namespace {

using Names = std::vector<std::string>;

[[noreturn]] void refuse(const Table& table, const std::string& field, const std::string& message,
                         std::size_t line = 0) {
  throw InputError({.file = table.source, .line = line, .field = field}, message);
}

// The columns in use, by their index in the table.
struct ColumnsInUse {
  std::vector<std::size_t> inputs;
  std::vector<std::size_t> targets;
  std::optional<std::size_t> time;
  std::optional<std::size_t> configuration;
  std::optional<std::size_t> held_out;
  std::vector<std::size_t> used;  // all of these
  std::optional<std::size_t> heading;
};

void check_roles(const Table& table, const Roles& roles) {
  if (roles.inputs.empty()) {
    refuse(table, "inputs", "no column is named; name them with --inputs");
  }
  if (roles.targets.empty()) {
    refuse(table, "targets", "no column is named; name them with --targets");
  }
  std::set<std::string_view> seen;
  for (const Names* const names : {&roles.inputs, &roles.targets}) {
    for (const std::string& name : *names) {
      if (!seen.insert(name).second) {
        refuse(table, name, "is named twice among the inputs and targets; name it once");
      }
    }
  }
  const bool has_rate = roles.rate_hz != 0.0;
  if (has_rate && !roles.time.empty()) {
    refuse(table, "time",
           fmt::format("both a time column ('{}') and a rate are given; give one", roles.time));
  }
  if (has_rate && (!std::isfinite(roles.rate_hz) || roles.rate_hz < 0.0)) {
    refuse(table, "rate",
           fmt::format("{} is out of range; it has to be > 0 rows per second", roles.rate_hz));
  }
  if (!has_rate && roles.time.empty()) {
    refuse(table, "time",
           "is unknown; name the time column with --time or give the rows per second with --rate" +
               unread_time_text(table));
  }
}

std::size_t use_column(const Table& table, const std::string& name, ColumnsInUse& columns) {
  const std::size_t column = table.find(name);
  table.require_numbers(column);
  if (std::ranges::none_of(table.columns[column], [](double x) { return std::isfinite(x); })) {
    refuse(table, name, "holds no finite number in any row; leave it out");
  }
  columns.used.push_back(column);
  return column;
}

ColumnsInUse find_columns(const Table& table, const Roles& roles) {
  ColumnsInUse columns;
  for (const std::string& name : roles.inputs) {
    columns.inputs.push_back(use_column(table, name, columns));
  }
  for (const std::string& name : roles.targets) {
    columns.targets.push_back(use_column(table, name, columns));
  }
  if (!roles.time.empty()) {
    columns.time = use_column(table, roles.time, columns);
  }
  if (!roles.configuration.empty()) {
    columns.configuration = use_column(table, roles.configuration, columns);
  }
  if (!roles.held_out.empty()) {
    columns.held_out = use_column(table, roles.held_out, columns);
  }
  const std::string heading = roles.heading.empty() ? find_heading(table) : roles.heading;
  if (!heading.empty()) {
    columns.heading = table.find(heading);
    table.require_numbers(*columns.heading);
  }
  return columns;
}

// Looks at the rows to be skipped, too: a clock that jumped there spoils all that follow.
void check_time(const Table& table, std::size_t column) {
  std::size_t line = 0;
  if (const std::string problem = time_order_problem(table, column, 0.0, line); !problem.empty()) {
    refuse(table, table.names[column], problem, line);
  }
}

int configuration_at(const Table& table, std::size_t column, std::size_t row) {
  constexpr double kMost = std::numeric_limits<int>::max();
  const double value = table.columns[column][row];
  if (value != std::trunc(value) || std::abs(value) > kMost) {
    refuse(table, table.names[column],
           fmt::format("{} can't number a configuration; whole numbers do", value),
           table.lines[row]);
  }
  return static_cast<int>(value);
}

bool held_out_at(const Table& table, std::size_t column, std::size_t row) {
  const double value = table.columns[column][row];
  if (value != 0.0 && value != 1.0) {
    refuse(table, table.names[column],
           fmt::format("{} doesn't say whether the row is held out; 1 (held out) or 0 does", value),
           table.lines[row]);
  }
  return value == 1.0;
}

void copy_rows(const Table& table, const ColumnsInUse& columns, double rate_hz, Dataset& data) {
  const double rows_per_s = rate_hz > 0.0 ? rate_hz : 1.0;
  const double unit_s = columns.time ? table.seconds_per_unit(*columns.time) : 1.0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto cell = [&](std::size_t column) { return table.columns[column][row]; };
    if (!std::ranges::all_of(columns.used, [&](auto c) { return std::isfinite(cell(c)); })) {
      ++data.rows_skipped;
      continue;
    }
    std::ranges::transform(columns.inputs, std::back_inserter(data.inputs), cell);
    std::ranges::transform(columns.targets, std::back_inserter(data.targets), cell);
    data.times_s.push_back(columns.time ? unit_s * cell(*columns.time)
                                        : static_cast<double>(row) / rows_per_s);
    data.configurations.push_back(
        columns.configuration ? configuration_at(table, *columns.configuration, row) : 0);
    if (columns.held_out) {
      data.held_out.push_back(held_out_at(table, *columns.held_out, row));
    }
    if (columns.heading) {
      data.headings.push_back(cell(*columns.heading));
    }
  }
  data.heading_column = columns.heading ? table.names[*columns.heading] : "";
}

void check_rows_left(const Table& table, const Dataset& data) {
  constexpr std::size_t kNeeded = 2;
  if (data.rows() < kNeeded) {
    refuse(table, {},
           fmt::format("{} of {} rows have a finite number in every column in use; {} or more are "
                       "needed",
                       data.rows(), data.rows_read, kNeeded));
  }
}

void check_varying(const Table& table, const Names& names, const std::vector<double>& values,
                   const std::string& consequence) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::size_t i = k;
    while (i < values.size() && values[i] == values[k]) {
      i += names.size();
    }
    if (i >= values.size()) {
      refuse(table, names[k], fmt::format("is {} in every row: {}", values[k], consequence));
    }
  }
}

}  // namespace

std::map<std::string, Unit> column_units(const Table& table, const Roles& roles) {
  std::map<std::string, Unit> units;
  for (std::size_t column = 0; column < table.units.size(); ++column) {
    if (!table.units[column].empty()) {
      units[table.names[column]] = Unit::parse(table.units[column]);
    }
  }
  for (const auto& [name, text] : roles.units) {
    table.find(name);
    units[name] = si_unit(table.source, name, text).first;
  }
  return units;
}

namespace {

const std::vector<double>& finite_column(const Table& table, const std::string& name) {
  const std::size_t column = table.find(name);
  table.require_numbers(column);
  const std::vector<double>& values = table.columns[column];
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (!std::isfinite(values[row])) {
      refuse(table, name, fmt::format("{} where a finite number is needed", values[row]),
             table.lines[row]);
    }
  }
  return values;
}

std::vector<double> command_times(const Table& table, const Roles& roles) {
  if (roles.rate_hz > 0.0) {
    return row_times_s(table, "", roles.rate_hz);
  }
  const std::string name = usual_time(table, roles);
  if (name.empty()) {
    refuse(table, "time",
           "there is no column t, time or stamp; name one with --time, or give --rate");
  }
  finite_column(table, name);
  const std::vector<double> times = row_times_s(table, name, 0.0);
  const auto later = std::ranges::adjacent_find(times, [](double a, double b) { return b <= a; });
  if (later != times.end()) {
    const auto row = static_cast<std::size_t>(later - times.begin()) + 1;
    refuse(table, name, fmt::format("{} s after {} s; time has to increase", times[row], *later),
           table.lines[row]);
  }
  return times;
}

}  // namespace

std::pair<Unit, double> si_unit(const std::string& source, const std::string& column,
                                const std::string& text) {
  try {
    return Unit::parse(text).in_si();
  } catch (const InputError& error) {
    throw InputError({.file = source, .field = column}, error.what());
  }
}

void convert_units(Table& table, const std::map<std::string, std::string>& units) {
  table.units.resize(table.names.size());
  for (const auto& [name, text] : units) {
    const std::size_t column = table.find(name);
    const auto [unit, factor] = si_unit(table.source, name, text);
    table.units[column] = factor == 1.0 ? text : unit.text();
    for (double& value : table.columns[column]) {
      value *= factor;
    }
  }
}

namespace {

// Whether a column can be the pulses of a servo or of a motor controller.
bool may_be_pulses(const Table& table, std::size_t column) {
  const std::string unit = column < table.units.size() ? table.units[column] : "";
  const auto begins_one_of = [](const std::string& word, std::initializer_list<const char*> all) {
    return std::ranges::any_of(all, [&](const char* start) { return word.starts_with(start); });
  };
  const std::vector<std::string> words = words_of(table.names[column]);
  const bool is_speed = std::ranges::any_of(words, [&](const std::string& word) {
    return begins_one_of(word, {"rpm", "rps", "rev", "speed", "omega", "engine"});
  });
  const bool is_command = names_thruster(table.names[column]) || names_fin(table.names[column]) ||
                          std::ranges::any_of(words, [&](const std::string& word) {
                            return begins_one_of(word, {"pwm", "chan", "steering"});
                          });
  return is_command && !is_speed && (unit.empty() || unit == "us" || unit == "µs");
}

}  // namespace

std::optional<std::size_t> zeros_among_pulses(std::span<const double> values) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::size_t zeros = 0;
  for (const double value : values) {
    if (value == 0.0) {
      ++zeros;
    } else if (std::isfinite(value)) {
      if (value != std::floor(value)) {
        return std::nullopt;
      }
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  return are_pulses_about_rest(low, high) ? std::optional(zeros) : std::nullopt;
}

std::string set_missing_pulses(Table& table) {
  std::vector<std::string> names;
  std::size_t rows = 0;
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    const std::size_t missing =
        may_be_pulses(table, column) ? zeros_among_pulses(table.columns[column]).value_or(0) : 0;
    if (missing > 0) {
      std::ranges::replace(table.columns[column], 0.0, kNeutralPulseUs);
      names.push_back(table.names[column]);
      rows = std::max(rows, missing);
    }
  }
  return names.empty()
             ? ""
             : fmt::format("{}: {}: 0 is no pulse; it counts as rest, {:g} µs, in {} {}\n",
                           table.source, join_text(names, ", "), kNeutralPulseUs, rows,
                           rows == 1 ? "row" : "rows");
}

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
    refuse(*this, name,
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
  refuse(
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
                                                                          {"ms", 1e-3},
                                                                          {"us", 1e-6},
                                                                          {"µs", 1e-6},
                                                                          {"ns", 1e-9},
                                                                          {"min", 60.0},
                                                                          {"h", 3600.0},
                                                                          {"d", 86'400.0},
                                                                          {"1", 1.0}}};
  const std::string given = column < units.size() ? units[column] : "";
  const std::string unit = given.empty() ? given : Unit::parse(given).text();
  const auto* const found =
      std::ranges::find(kSeconds, unit, &decltype(kSeconds)::value_type::first);
  if (found == kSeconds.end()) {
    refuse(*this, names[column],
           fmt::format("is in {}, which is not a unit of time; use s or ms", given));
  }
  return found->second;
}

double measured_rate(const std::vector<double>& times_s) {
  std::vector<double> steps;
  for (std::size_t row = 1; row < times_s.size(); ++row) {
    if (times_s[row] > times_s[row - 1]) {
      steps.push_back(times_s[row] - times_s[row - 1]);
    }
  }
  if (steps.empty()) {
    return 0.0;
  }
  return 1.0 / quantile(steps, 0.5);
}

Dataset make_dataset(const Table& table, const Roles& roles) {
  check_roles(table, roles);
  const ColumnsInUse columns = find_columns(table, roles);
  if (columns.time) {
    check_time(table, *columns.time);
  }
  Dataset data;
  data.source = table.source;
  data.input_names = roles.inputs;
  data.time_column = roles.time;
  for (const std::size_t column : columns.targets) {
    data.target_names.push_back(table.names[column]);
  }
  data.units = column_units(table, roles);
  data.actuators = roles.actuators;
  data.rows_read = table.rows();
  copy_rows(table, columns, roles.rate_hz, data);
  check_rows_left(table, data);
  data.rate_hz = columns.time ? measured_rate(data.times_s) : roles.rate_hz;
  if (data.rate_hz == 0.0) {
    refuse(table, roles.time, "time stands still; its stamps have to increase");
  }
  check_varying(table, data.target_names, data.targets,
                "nothing to learn, R² is not defined; leave it out with --targets");
  return data;
}

Dataset make_commands(const Table& table, const Roles& roles,
                      const std::map<std::string, double>& constants) {
  if (table.rows() < 2) {
    refuse(table, "rows", fmt::format("{}; at least two are needed", table.rows()));
  }
  Dataset data;
  data.source = table.source;
  data.input_names = roles.inputs;
  data.times_s = command_times(table, roles);
  data.rate_hz = measured_rate(data.times_s);
  data.rows_read = table.rows();
  const std::size_t inputs = roles.inputs.size();
  data.inputs.resize(table.rows() * inputs);
  for (std::size_t i = 0; i < inputs; ++i) {
    const auto constant = constants.find(roles.inputs[i]);
    const std::vector<double> values = constant == constants.end()
                                           ? finite_column(table, roles.inputs[i])
                                           : std::vector<double>(table.rows(), constant->second);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      data.inputs[row * inputs + i] = values[row];
    }
  }
  return data;
}

std::optional<std::size_t> Dataset::find_input(std::string_view name) const {
  const auto found = std::ranges::find(input_names, name);
  return found == input_names.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - input_names.begin()));
}

std::size_t Dataset::require_input(const std::string& name, const std::string& need) const {
  const std::optional<std::size_t> found = find_input(name);
  if (!found) {
    throw InputError({.file = source, .line = 0, .field = name}, need + ", but is no input");
  }
  return *found;
}

std::size_t Dataset::require_input_of(std::string_view option, const std::string& name) const {
  return require_name(option, name, "input", input_names);
}

}  // namespace kelpie::log
