// SPDX-License-Identifier: Apache-2.0
#include "log/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kelpie/core/error.hpp"

namespace kelpie::log {
namespace {

const std::vector<double>& finite_column(const Table& table, const std::string& name) {
  const std::size_t column = table.find(name);
  table.require_numbers(column);
  const std::vector<double>& values = table.columns[column];
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (!std::isfinite(values[row])) {
      throw InputError({.file = table.source, .line = table.lines[row], .field = name},
                       fmt::format("{} where a finite number is needed", values[row]));
    }
  }
  return values;
}

std::string time_column(const Table& table, const Roles& roles) {
  if (!roles.time.empty()) {
    return roles.time;
  }
  for (const std::string_view name : kTimeNames) {
    if (std::ranges::find(table.names, name) != table.names.end()) {
      return std::string(name);
    }
  }
  throw InputError({.file = table.source, .field = "time"},
                   "there is no column t, time or stamp; name one with --time, or give --rate");
}

std::vector<double> row_times(const Table& table, const Roles& roles) {
  std::vector<double> times(table.rows());
  if (roles.rate_hz > 0.0) {
    for (std::size_t row = 0; row < times.size(); ++row) {
      times[row] = static_cast<double>(row) / roles.rate_hz;
    }
    return times;
  }
  const std::string name = time_column(table, roles);
  times = finite_column(table, name);
  const auto later = std::ranges::adjacent_find(times, [](double a, double b) { return b <= a; });
  if (later != times.end()) {
    const auto row = static_cast<std::size_t>(later - times.begin()) + 1;
    throw InputError({.file = table.source, .line = table.lines[row], .field = name},
                     fmt::format("{} s after {} s; time has to increase", times[row], *later));
  }
  return times;
}

}  // namespace

Dataset make_commands(const Table& table, const Roles& roles,
                      const std::map<std::string, double>& constants) {
  if (table.rows() < 2) {
    throw InputError({.file = table.source, .field = "rows"},
                     fmt::format("{}; there have to be two at least", table.rows()));
  }
  Dataset data;
  data.source = table.source;
  data.input_names = roles.inputs;
  data.times_s = row_times(table, roles);
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

}  // namespace kelpie::log
