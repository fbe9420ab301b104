// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"
#include "log/dataset.hpp"

namespace kelpie::log {
namespace {

constexpr std::array<std::string_view, 2> kConfigurations{"conf", "configuration"};
constexpr std::string_view kSplit = "split";

bool is_among(std::string_view name, const auto& names) {
  return std::ranges::find(names, name) != std::ranges::end(names);
}

[[noreturn]] void refuse(const Table& table, const std::string& part, const std::string& message) {
  throw InputError({.file = table.source, .line = 0, .field = part},
                   message + "; the columns are " + join_text(table.names, ", "));
}

// Whether `stem` is a column that another can be named after: "dt" beside "t" is no acceleration.
bool is_quantity(const Table& table, std::string_view stem) {
  return is_among(stem, table.names) && !is_among(stem, kTimeNames);
}

bool is_quantity_with(const Table& table, std::string_view name, std::string_view ending) {
  return name.ends_with(ending) && is_quantity(table, name.substr(0, name.size() - ending.size()));
}

bool is_acceleration(const Table& table, std::string_view name) {
  return is_quantity_with(table, name, "_dot") || is_quantity_with(table, name, "dot") ||
         (name.starts_with('d') && is_quantity(table, name.substr(1)));
}

bool can_be_input(const Table& table, std::size_t column, const Roles& roles) {
  const std::string& name = table.names[column];
  const bool has_part = is_among(name, roles.targets) || name == roles.time ||
                        name == roles.configuration || name == roles.held_out ||
                        is_among(name, kTimeNames) || is_among(name, kConfigurations) ||
                        name == kSplit;
  return !has_part && !is_acceleration(table, name) && !is_quantity_with(table, name, "_true") &&
         !table.has_text(column);
}

}  // namespace

Roles guess_roles(const Table& table, const Roles& given) {
  Roles roles = given;
  for (const std::string& name : table.names) {
    if (roles.time.empty() && roles.rate_hz == 0.0 && is_among(name, kTimeNames)) {
      roles.time = name;
    }
    if (roles.configuration.empty() && is_among(name, kConfigurations)) {
      roles.configuration = name;
    }
    if (given.targets.empty() && is_acceleration(table, name) && !is_among(name, given.inputs)) {
      roles.targets.push_back(name);
    }
  }
  if (roles.targets.empty()) {
    refuse(table, "targets",
           "no column is named like the derivative of another (udot, u_dot or du beside u); name "
           "them with --targets");
  }
  for (std::size_t column = 0; column < table.names.size() && given.inputs.empty(); ++column) {
    if (can_be_input(table, column, roles)) {
      roles.inputs.push_back(table.names[column]);
    }
  }
  if (roles.inputs.empty()) {
    refuse(table, "inputs", "no column of numbers is left for them; name them with --inputs");
  }
  return roles;
}

}  // namespace kelpie::log
