// SPDX-License-Identifier: Apache-2.0
#include "log/validity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "core/quantile.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "log/known_roles.hpp"
#include "log/tuning.hpp"

namespace kelpie::log {
namespace {

constexpr const auto& kValidity = kTuning.validity;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kKeeps = "; --missing none keeps such rows";

bool is_none(const Roles& given) {
  return std::ranges::count(given.missing, "none") > 0;
}

bool is_near(double value, double mark) {
  return std::abs(value - mark) <= kValidity.rounding * std::abs(mark);
}

std::vector<std::size_t> velocity_columns(const Table& table) {
  std::vector<std::size_t> found;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (const auto axis = velocity_by_name(table.names[column]);
        axis && *axis < 3 && !table.is_of_words(column)) {
      found.push_back(column);
    }
  }
  return found;
}

// What a cell of words says of validity; empty: no word for it.
std::optional<bool> validity_of(std::string word) {
  constexpr std::array<std::string_view, 10> kValid{"true", "t",  "yes",  "y",    "valid",
                                                    "ok",   "on", "good", "lock", "a"};
  constexpr std::array<std::string_view, 11> kInvalid{
      "false", "f", "no", "n", "invalid", "bad", "off", "lost", "none", "fail", "v"};
  std::ranges::transform(word, word.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool is_valid = std::ranges::count(kValid, word) > 0;
  return is_valid || std::ranges::count(kInvalid, word) > 0 ? std::optional(is_valid)
                                                            : std::nullopt;
}

// The rows that a column of flags calls invalid; empty: it is no such column.
Rows flagged_rows(const Table& table, std::size_t column) {
  const std::optional<Validity> known = validity_by_name(table.names[column]);
  if (!known) {
    return {};
  }
  Rows rows;
  const std::vector<double>& values = table.columns[column];
  std::size_t words = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const bool is_word = table.has_text(column) && words < table.texts[column].words.size() &&
                         table.texts[column].words[words].first == row;
    std::optional<bool> is_valid;
    if (is_word) {
      is_valid = validity_of(table.texts[column].words[words++].second);
    } else if (*known == Validity::merit) {
      is_valid = !(values[row] > kValidity.most_merit);
    } else if (values[row] == 0.0 || values[row] == 1.0) {
      is_valid = values[row] == 1.0;
    } else if (std::isnan(values[row])) {
      continue;
    }
    if (!is_valid) {
      return {};
    }
    if (*is_valid == (*known == Validity::where_0)) {
      rows.push_back(row);
    }
  }
  return rows;
}

std::string names_of(const Table& table, const std::vector<std::size_t>& columns) {
  std::vector<std::string> names;
  for (const std::size_t column : columns) {
    names.push_back(table.names[column]);
  }
  return join_text(names, ", ");
}

// Without the rows' velocities. Returns the line about it.
std::string drop(Table& table, const std::vector<std::size_t>& columns, const Rows& rows,
                 const std::string& why) {
  for (const std::size_t column : columns) {
    drop_rows(rows, table.columns[column]);
  }
  if (rows.size() == table.rows()) {
    throw InputError({.file = table.source},
                     "no velocity was measured: " + why + " in every row. Nothing can be learned");
  }
  return fmt::format("{}: {} in {} {}, the first on line {}: {} not measured there{}\n",
                     table.source, why, rows.size(), rows.size() == 1 ? "row" : "rows",
                     table.lines[rows.front()],
                     names_of(table, columns) + (columns.size() == 1 ? " is" : " are"), kKeeps);
}

// The value that stands for none in a signal; empty: none.
std::optional<double> mark_of_none(std::span<const double> values) {
  constexpr std::array<double, 11> kMarks{-32.768, 32.767, -32768, 32767,   -999, 999,
                                          -9999,   9999,   -99999, -327.68, 99999};
  double farthest = 0.0;
  for (const double value : values) {
    if (std::isfinite(value) && std::abs(value) > std::abs(farthest)) {
      farthest = value;
    }
  }
  double next = 0.0;
  std::size_t count = 0;
  std::size_t finite = 0;
  for (const double value : values) {
    const bool is_one = std::isfinite(value) && is_near(value, farthest);
    count += is_one ? 1 : 0;
    finite += std::isfinite(value) ? 1 : 0;
    next = std::isfinite(value) && !is_one ? std::max(next, std::abs(value)) : next;
  }
  const bool is_known = std::ranges::any_of(
      kMarks, [&](double mark) { return std::abs(farthest) > 0.0 && is_near(farthest, mark); });
  const bool is_far = count < finite && next > 0.0 && std::abs(farthest) > kValidity.far * next;
  return is_far && (is_known || count >= kValidity.least_marks) ? std::optional(farthest)
                                                                : std::nullopt;
}

}  // namespace

Rows missing_rows(std::span<const double> values, const Roles& given,
                  std::initializer_list<std::string_view> names) {
  Rows rows;
  for (const std::string& text : given.missing) {
    const std::size_t sign = text.rfind('=');
    const std::string_view column =
        sign == std::string::npos ? "" : std::string_view(text).substr(0, sign);
    double value = 0.0;
    if (text == "none") {
      continue;
    }
    if (!parse_number(text.substr(sign == std::string::npos ? 0 : sign + 1), value)) {
      throw InputError("--missing", "'" + text + "' is no number; write -999, u=-999, or none");
    }
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (values[row] == value && (column.empty() || std::ranges::count(names, column) > 0)) {
        rows.push_back(row);
      }
    }
  }
  return rows;
}

Rows mark_rows(std::span<const double> values, const Roles& given) {
  const std::optional<double> mark = is_none(given) ? std::nullopt : mark_of_none(values);
  Rows rows;
  for (std::size_t row = 0; mark && row < values.size(); ++row) {
    if (is_near(values[row], *mark)) {
      rows.push_back(row);
    }
  }
  return rows;
}

Rows zero_rows(const std::vector<std::span<const double>>& velocities, const Roles& given) {
  if (velocities.size() < 2 || is_none(given)) {
    return {};
  }
  std::vector<double> speeds(velocities.front().size());
  std::vector<double> moving;
  for (std::size_t row = 0; row < speeds.size(); ++row) {
    for (const std::span<const double> velocity : velocities) {
      const double speed = std::abs(velocity[row]);
      speeds[row] = std::isnan(speed) ? speed : std::max(speeds[row], speed);
    }
    if (speeds[row] > 0.0) {
      moving.push_back(speeds[row]);
    }
  }
  const double jump = moving.empty() ? HUGE_VAL : kValidity.least_jump * quantile(moving, 0.9);
  Rows rows;
  for (std::size_t row = 0; row < speeds.size();) {
    std::size_t end = row;
    while (end < speeds.size() && speeds[end] == 0.0) {
      ++end;
    }
    const bool jumps =
        row > 0 && end < speeds.size() && speeds[row - 1] > jump && speeds[end] > jump;
    for (std::size_t k = row; jumps && end - row >= kValidity.least_zeros && k < end; ++k) {
      rows.push_back(k);
    }
    row = std::max(end, row + 1);
  }
  return rows;
}

namespace {

// Rows of one number on end.
struct Run {
  std::size_t first = 0;
  std::size_t count = 0;
};

std::vector<Run> runs_of(std::span<const double> values) {
  std::vector<Run> runs;
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (!runs.empty() && values[row] == values[row - 1]) {
      ++runs.back().count;
    } else {
      runs.push_back({row, 1});
    }
  }
  return runs;
}

// The least length of a run that is no usual one of the signal; 0: all are usual.
std::size_t least_freeze(const std::vector<Run>& runs) {
  std::vector<std::size_t> lengths;
  std::ranges::transform(runs, std::back_inserter(lengths), &Run::count);
  std::ranges::sort(lengths);
  for (std::size_t k = 1; k < lengths.size(); ++k) {
    if (lengths[k] >= kValidity.frozen_rows &&
        lengths[k] >= kValidity.frozen_times * lengths[k - 1]) {
      return lengths[k];
    }
  }
  return 0;
}

// The usual size of a change from row to row.
double usual_step(std::span<const double> values) {
  std::vector<double> steps;
  for (std::size_t row = 1; row < values.size(); ++row) {
    const double step = std::abs(values[row] - values[row - 1]);
    if (step > 0.0) {
      steps.push_back(step);
    }
  }
  return steps.empty() ? 0.0 : quantile(steps, kValidity.usual_step);
}

bool changes_within(std::span<const double> values, const Run& run) {
  std::size_t changes = 0;
  for (std::size_t row = run.first + 1; row < run.first + run.count; ++row) {
    changes += std::isfinite(values[row]) && values[row] != values[row - 1] ? 1 : 0;
  }
  return changes * kValidity.moving_rows >= run.count;
}

}  // namespace

Rows frozen_rows(const std::vector<std::span<const double>>& velocities, std::size_t frozen,
                 const Roles& given) {
  if (is_none(given)) {
    return {};
  }
  const std::span<const double> values = velocities[frozen];
  const std::vector<Run> runs = runs_of(values);
  const std::size_t least = least_freeze(runs);
  const double step = least > 0 ? usual_step(values) : 0.0;
  Rows rows;
  for (const Run& run : runs) {
    const std::size_t end = run.first + run.count;
    const bool is_long = least > 0 && run.count >= least && values[run.first] != 0.0;
    const bool jumps = end == values.size() || std::abs(values[end] - values[run.first]) > step;
    const auto moves = [&](std::span<const double> other) {
      return other.data() != values.data() && changes_within(other, run);
    };
    for (std::size_t row = run.first + 1;
         is_long && jumps && std::ranges::any_of(velocities, moves) && row < end; ++row) {
      rows.push_back(row);
    }
  }
  return rows;
}

void drop_rows(const Rows& rows, std::vector<double>& values) {
  for (const std::size_t row : rows) {
    values[row] = kNone;
  }
}

namespace {

// Without the frozen values of velocities and rates. Returns the lines about them.
std::string drop_frozen(Table& table, const Roles& given) {
  std::vector<std::size_t> columns;
  std::vector<std::span<const double>> motion;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (velocity_by_name(table.names[column]) && !table.is_of_words(column)) {
      columns.push_back(column);
      motion.emplace_back(table.columns[column]);
    }
  }
  std::string told;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (const Rows rows = frozen_rows(motion, k, given); !rows.empty()) {
      told +=
          drop(table, {columns[k]}, rows,
               fmt::format("{}: frozen at {:g}", table.names[columns[k]], motion[k][rows.front()]));
    }
  }
  return told;
}

}  // namespace

std::string drop_missing(Table& table, const Roles& given) {
  for (const std::string& text : given.missing) {
    if (const std::size_t sign = text.rfind('='); sign != std::string::npos) {
      table.find(text.substr(0, sign));
    }
  }
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    std::vector<double>& values = table.columns[column];
    drop_rows(missing_rows(values, given, {table.names[column]}), values);
  }
  const std::vector<std::size_t> velocities = velocity_columns(table);
  if (is_none(given) || velocities.empty()) {
    return "";
  }
  std::string told;
  const auto drop_if_any = [&](const std::vector<std::size_t>& columns, const Rows& rows,
                               const std::string& why) {
    told += rows.empty() ? "" : drop(table, columns, rows, why);
  };
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    const std::string& name = table.names[column];
    const std::vector<double>& values = table.columns[column];
    drop_if_any(velocities, flagged_rows(table, column), name + " calls velocities invalid");
    const Rows rows = velocity_by_name(name) ? mark_rows(values, given) : Rows{};
    if (!rows.empty()) {
      const double mark = values[rows.front()];
      drop_if_any({column}, rows,
                  fmt::format("{}: {:g}, a sensor's mark of no value,", name, mark));
    }
  }
  std::vector<std::span<const double>> all;
  std::ranges::transform(velocities, std::back_inserter(all), [&](std::size_t column) {
    return std::span<const double>(table.columns[column]);
  });
  drop_if_any(velocities, zero_rows(all, given),
              names_of(table, velocities) + ": exact zeros between rows of a moving vehicle");
  return told + drop_frozen(table, given);
}

}  // namespace kelpie::log
