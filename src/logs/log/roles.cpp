// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/scaling.hpp"
#include "log/dataset.hpp"
#include "motion/states.hpp"

namespace kelpie::log {
namespace {

constexpr std::array<std::string_view, 2> kConfigurations{"conf", "configuration"};
constexpr std::string_view kSplit = "split";
// Columns that say where or when, which no dynamics depend on.
constexpr std::array<std::string_view, 17> kPlaces{
    "depth", "lat",  "lon",  "latitude", "longitude", "altitude", "px",    "py",   "pz",
    "north", "east", "down", "easting",  "northing",  "pos_x",    "pos_y", "pos_z"};
constexpr std::array<std::string_view, 8> kCounters{"run", "index", "idx",   "row",
                                                    "seq", "count", "frame", "window"};

bool is_among(std::string_view name, const auto& names) {
  return std::ranges::find(names, name) != std::ranges::end(names);
}

// The values of a column; none in a table of names alone.
std::span<const double> values_of(const Table& table, std::size_t column) {
  return column < table.columns.size() ? std::span(table.columns[column])
                                       : std::span<const double>{};
}

bool is_constant(std::span<const double> values) {
  const auto differs = [&](double value) {
    return std::isfinite(value) && value != values.front();
  };
  return values.size() > 1 && std::isfinite(values.front()) &&
         std::ranges::none_of(values, differs);
}

// Whether every row has the number after the row before; a few rows may do so by chance.
bool counts_rows(std::span<const double> values) {
  constexpr std::size_t kFew = 20;
  const auto unequal = [](double before, double after) { return after != before + 1.0; };
  return values.size() > kFew && std::ranges::adjacent_find(values, unequal) == values.end();
}

// Whether two columns say the same in every row; gaps (NaN) equal each other.
bool are_equal(std::span<const double> a, std::span<const double> b) {
  return a.size() > 1 && std::ranges::equal(a, b, [](double x, double y) {
           return x == y || (std::isnan(x) && std::isnan(y));
         });
}

// What the names of a table's columns tell of each other.
class Header {
 public:
  explicit Header(const Table& table)
      : table_(table), names_(table.names.begin(), table.names.end()) {
    for (std::size_t column = 0; column < table.texts.size(); ++column) {
      if (table.is_time(column)) {
        stamps_.insert(table.names[column]);
      }
    }
  }

  [[noreturn]] void refuse(const std::string& part, const std::string& message) const {
    throw InputError({.file = table_.source, .field = part}, message + "; " + columns_text(table_));
  }

  bool is_acceleration(std::string_view name) const {
    return is_quantity_with(name, "_dot") || is_quantity_with(name, "dot") ||
           (name.starts_with('d') && is_quantity(name.substr(1)));
  }

  // Whether it would be an input if it holds numbers.
  bool can_be_input(const std::string& name, const Roles& roles) const {
    const bool has_part = is_stamp(name) || is_among(name, roles.targets) || name == roles.time ||
                          name == roles.configuration || name == roles.held_out ||
                          is_among(name, kTimeNames) || is_among(name, kConfigurations) ||
                          name == kSplit;
    return !has_part && !is_acceleration(name) && !is_quantity_with(name, "_true");
  }

  bool is_stamp(std::string_view name) const { return stamps_.contains(name); }

 private:
  // Whether `stem` is a column that another can be named after: "dt" beside "t" is no acceleration.
  bool is_quantity(std::string_view stem) const {
    return names_.contains(stem) && !is_among(stem, kTimeNames);
  }
  bool is_quantity_with(std::string_view name, std::string_view ending) const {
    return name.ends_with(ending) && is_quantity(name.substr(0, name.size() - ending.size()));
  }

  const Table& table_;
  std::unordered_set<std::string_view> names_;
  std::unordered_set<std::string_view> stamps_;
};

// Why a column that could be an input is left out of the guessed inputs; empty: an input.
// `inputs`: the inputs so far.
std::string reason_against(const Table& table, std::size_t column,
                           const std::vector<std::string>& inputs) {
  const std::string& name = table.names[column];
  const std::span<const double> values = values_of(table, column);
  if (table.is_of_words(column)) {
    return fmt::format("'{}' is not a number", table.texts[column].cell);
  }
  if (is_among(name, kCounters) || counts_rows(values)) {
    return "a counter";
  }
  if (is_among(name, kPlaces)) {
    return "a position";
  }
  if (is_constant(values)) {
    return fmt::format("{} in every row", values.front());
  }
  for (const std::string& earlier : inputs) {
    if (are_equal(values, values_of(table, table.find(earlier)))) {
      return "equals " + earlier + " in every row";
    }
  }
  return "";
}

// A column that is no input although its name allows one.
struct LeftOut {
  std::size_t column;
  std::string reason;
};

// Adds the columns that are inputs to the roles. Returns the others that could be.
std::vector<LeftOut> add_inputs(const Table& table, const Header& header, Roles& roles) {
  std::vector<LeftOut> left_out;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (!header.can_be_input(table.names[column], roles)) {
      continue;
    }
    const std::string reason = reason_against(table, column, roles.inputs);
    if (!reason.empty()) {
      left_out.push_back({column, reason});
      continue;
    }
    roles.inputs.push_back(table.names[column]);
    if (roles.inputs.size() > kMostInputs) {
      header.refuse("inputs", fmt::format("more than {} columns are left for them, which no model "
                                          "takes; name them with --inputs",
                                          kMostInputs));
    }
  }
  return left_out;
}

// Velocities stand first, in the order of their axes within the log.
void put_velocities_first(std::vector<std::string>& inputs) {
  std::ranges::stable_partition(
      inputs, [](const std::string& name) { return velocity_axis(name).has_value(); });
}

// All parts but the inputs.
Roles guess_other_roles(const Table& table, const Header& header, const Roles& given) {
  Roles roles = given;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    const std::string& name = table.names[column];
    if (roles.time.empty() && roles.rate_hz == 0.0 && is_among(name, kTimeNames)) {
      roles.time = name;
    }
    if (roles.configuration.empty() && is_among(name, kConfigurations)) {
      roles.configuration = name;
    }
    if (given.targets.empty() && header.is_acceleration(name) && !is_among(name, given.inputs) &&
        !is_constant(values_of(table, column))) {
      roles.targets.push_back(name);
    }
  }
  const auto stamps = std::ranges::find_if(
      table.names, [&](const std::string& name) { return header.is_stamp(name); });
  if (roles.time.empty() && roles.rate_hz == 0.0 && stamps != table.names.end()) {
    roles.time = *stamps;
  }
  return roles;
}

}  // namespace

Roles guess_roles(const Table& table, const Roles& given) {
  const Header header(table);
  Roles roles = guess_other_roles(table, header, given);
  if (roles.targets.empty()) {
    header.refuse("targets",
                  "no column is named like the derivative of another (udot, u_dot or du beside u); "
                  "name them with --targets");
  }
  if (given.inputs.empty()) {
    add_inputs(table, header, roles);
  }
  if (roles.inputs.empty()) {
    header.refuse("inputs",
                  "no column of numbers that change is left for them; name them with --inputs");
  }
  if (given.inputs.empty()) {
    put_velocities_first(roles.inputs);
  }
  return roles;
}

std::string left_out_text(const Table& table, const Roles& given) {
  std::string text;
  if (!given.inputs.empty()) {
    return text;
  }
  const Header header(table);
  Roles roles = guess_other_roles(table, header, given);
  for (const LeftOut& one : add_inputs(table, header, roles)) {
    const std::string line =
        table.has_text(one.column) ? fmt::format(":{}", table.texts[one.column].line) : "";
    text += fmt::format("{}{}: {}: is left out of the inputs: {}\n", table.source, line,
                        table.names[one.column], one.reason);
  }
  return text;
}

}  // namespace kelpie::log
