// SPDX-License-Identifier: Apache-2.0
#include "kelpie/data/dataset.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kelpie/core/error.hpp"
#include "kelpie/core/quantile.hpp"
#include "kelpie/core/setting.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie {
namespace {

[[noreturn]] void refuse(const Table& table, const std::string& field, const std::string& message,
                         std::size_t line = 0) {
  throw InputError({.file = table.source, .line = line, .field = field}, message);
}

std::vector<std::size_t> find_columns(const Table& table, const std::vector<std::string>& names) {
  std::vector<std::size_t> columns;
  for (const std::string& name : names) {
    const std::size_t column = table.find(name);
    table.require_numbers(column);
    columns.push_back(column);
  }
  return columns;
}

void check_roles(const Table& table, const Roles& roles) {
  if (roles.inputs.empty()) {
    refuse(table, "inputs", "no input column is named");
  }
  if (roles.targets.empty()) {
    refuse(table, "targets", "no target column is named");
  }
  std::vector<std::string> seen;
  for (const auto* const names : {&roles.inputs, &roles.targets}) {
    for (const std::string& name : *names) {
      if (std::ranges::find(seen, name) != seen.end()) {
        refuse(table, name, "is named twice among the inputs and targets");
      }
      seen.push_back(name);
    }
  }
  if (roles.time.empty() == (roles.rate_hz == 0.0)) {
    refuse(table, "time",
           roles.time.empty() ? "not known; give the time column (--time) or the rows per second "
                                "(--rate)"
                              : "given twice; give a time column or a rate");
  }
  if (roles.time.empty() && !(std::isfinite(roles.rate_hz) && roles.rate_hz > 0.0)) {
    refuse(table, "rate",
           number_text(roles.rate_hz) + " is out of range; it has to be > 0 rows per second");
  }
}

void check_varying(const Table& table, const Dataset& data, const std::vector<double>& values,
                   const std::vector<std::string>& names, const std::string& consequence) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    bool varies = false;
    for (std::size_t row = 1; row < data.rows() && !varies; ++row) {
      varies = values[row * names.size() + k] != values[k];
    }
    if (!varies) {
      refuse(table, names[k], "is constant (" + number_text(values[k]) + ") " + consequence);
    }
  }
}

// Time may not run backwards even across rows that are skipped.
void check_time(const Table& table, std::size_t column) {
  double last = -HUGE_VAL;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double now = table.columns[column][row];
    if (now < last) {
      refuse(table, table.names[column],
             "time runs backwards, from " + number_text(last) + " to " + number_text(now) + " s",
             table.lines[row]);
    }
    last = std::isfinite(now) ? now : last;
  }
}

int configuration_number(const Table& table, std::size_t column, std::size_t row) {
  constexpr double kLargest = 1e6;
  const double value = table.columns[column][row];
  if (value != std::floor(value) || std::abs(value) > kLargest) {
    refuse(table, table.names[column],
           number_text(value) + " doesn't number a configuration; whole numbers do",
           table.lines[row]);
  }
  return static_cast<int>(value);
}

double measured_rate(const std::vector<double>& times_s) {
  std::vector<double> steps;
  for (std::size_t row = 1; row < times_s.size(); ++row) {
    steps.push_back(times_s[row] - times_s[row - 1]);
  }
  const double step = quantile(steps, 0.5);
  return step > 0.0 ? 1.0 / step : 0.0;
}

std::string acceleration_of(const std::string& target, const Table& table) {
  const auto exists = [&](const std::string& name) {
    return std::ranges::find(table.names, name) != table.names.end();
  };
  for (const std::string ending : {"_dot", "dot"}) {
    const std::string stem =
        target.substr(0, target.size() - std::min(target.size(), ending.size()));
    if (target.ends_with(ending) && exists(stem)) {
      return stem;
    }
  }
  return target.starts_with('d') && exists(target.substr(1)) ? target.substr(1) : "";
}

bool is_one_of(const std::string& name, const std::vector<std::string>& names) {
  return std::ranges::find(names, name) != names.end();
}

bool has_words(const Table& table, std::size_t column) {
  return !table.texts.empty() && table.texts[column].line > 0;
}

}  // namespace

std::size_t Table::find(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    refuse(*this, name,
           "there is no such column" + did_you_mean(name, names) + "; the columns are " +
               join_text(names, ", "));
  }
  return static_cast<std::size_t>(found - names.begin());
}

void Table::require_numbers(std::size_t column) const {
  if (!has_words(*this, column)) {
    return;
  }
  const Text& text = texts[column];
  const bool decimal_comma = text.cell.find(',') != std::string::npos;
  refuse(*this, names[column],
         "'" + text.cell + "' is not a number" +
             (decimal_comma ? " (decimals are separated by a point)" : ""),
         text.line);
}

Roles guess_roles(const Table& table, const Roles& given) {
  Roles roles = given;
  const std::vector<std::string> times{"t", "time", "stamp"};
  const std::vector<std::string> configurations{"conf", "configuration"};
  for (const std::string& name : table.names) {
    if (roles.time.empty() && roles.rate_hz == 0.0 && is_one_of(name, times)) {
      roles.time = name;
    }
    if (roles.configuration.empty() && is_one_of(name, configurations)) {
      roles.configuration = name;
    }
    if (given.targets.empty() && !acceleration_of(name, table).empty()) {
      roles.targets.push_back(name);
    }
  }
  if (roles.targets.empty()) {
    refuse(table, "targets",
           "no column is named like an acceleration of another (u and udot); "
           "name them with --targets. The columns are " +
               join_text(table.names, ", "));
  }
  if (!given.inputs.empty()) {
    return roles;
  }
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    const std::string& name = table.names[column];
    const bool taken = is_one_of(name, roles.targets) || is_one_of(name, times) ||
                       is_one_of(name, configurations) || name == roles.time ||
                       name == roles.configuration || name == "split" || name.ends_with("_true") ||
                       !acceleration_of(name, table).empty();
    if (!taken && !has_words(table, column)) {
      roles.inputs.push_back(name);
    }
  }
  if (roles.inputs.empty()) {
    refuse(table, "inputs", "no column is left for them; name them with --inputs");
  }
  return roles;
}

Dataset make_dataset(const Table& table, const Roles& roles) {
  check_roles(table, roles);
  const std::vector<std::size_t> inputs = find_columns(table, roles.inputs);
  const std::vector<std::size_t> targets = find_columns(table, roles.targets);
  std::vector<std::size_t> used = inputs;
  used.insert(used.end(), targets.begin(), targets.end());
  const bool timed = !roles.time.empty();
  const std::size_t time = timed ? find_columns(table, {roles.time}).front() : 0;
  const bool configured = !roles.configuration.empty();
  const std::size_t configuration =
      configured ? find_columns(table, {roles.configuration}).front() : 0;
  if (timed) {
    check_time(table, time);
    used.push_back(time);
  }
  if (configured) {
    used.push_back(configuration);
  }

  Dataset data;
  data.source = table.source;
  data.input_names = roles.inputs;
  data.target_names = roles.targets;
  data.rows_read = table.rows();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto finite = [&](std::size_t column) {
      return std::isfinite(table.columns[column][row]);
    };
    if (!std::ranges::all_of(used, finite)) {
      ++data.rows_skipped;
      continue;
    }
    const auto cell = [&](std::size_t column) { return table.columns[column][row]; };
    std::ranges::transform(inputs, std::back_inserter(data.inputs), cell);
    std::ranges::transform(targets, std::back_inserter(data.targets), cell);
    data.times_s.push_back(timed ? cell(time) : static_cast<double>(row) / roles.rate_hz);
    data.configurations.push_back(configured ? configuration_number(table, configuration, row) : 0);
  }
  if (data.rows() < 2) {
    refuse(table, "rows",
           "fewer than two rows have finite numbers in all columns in use (" +
               std::to_string(data.rows_skipped) + " of " + std::to_string(table.rows()) +
               " were skipped)");
  }
  check_varying(table, data, data.inputs, data.input_names,
                "so that the covariance Σ is singular; leave it out of the inputs");
  check_varying(table, data, data.targets, data.target_names,
                "so that there is nothing to learn; leave it out of the targets");
  data.rate_hz = timed ? measured_rate(data.times_s) : roles.rate_hz;
  return data;
}

}  // namespace kelpie
