// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <unordered_set>

#include "kelpie/core/error.hpp"
#include "kelpie/core/scaling.hpp"
#include "log/dataset.hpp"

namespace kelpie::log {
namespace {

constexpr std::array<std::string_view, 2> kConfigurations{"conf", "configuration"};
constexpr std::string_view kSplit = "split";

bool is_among(std::string_view name, const auto& names) {
  return std::ranges::find(names, name) != std::ranges::end(names);
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

// All parts but the inputs.
Roles guess_other_roles(const Table& table, const Header& header, const Roles& given) {
  Roles roles = given;
  for (const std::string& name : table.names) {
    if (roles.time.empty() && roles.rate_hz == 0.0 && is_among(name, kTimeNames)) {
      roles.time = name;
    }
    if (roles.configuration.empty() && is_among(name, kConfigurations)) {
      roles.configuration = name;
    }
    if (given.targets.empty() && header.is_acceleration(name) && !is_among(name, given.inputs)) {
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
  for (std::size_t column = 0; column < table.names.size() && given.inputs.empty(); ++column) {
    if (header.can_be_input(table.names[column], roles) && !table.is_of_words(column)) {
      roles.inputs.push_back(table.names[column]);
    }
    if (roles.inputs.size() > kMostInputs) {
      header.refuse("inputs", fmt::format("more than {} columns are left for them, which no model "
                                          "takes; name them with --inputs",
                                          kMostInputs));
    }
  }
  if (roles.inputs.empty()) {
    header.refuse("inputs", "no column of numbers is left for them; name them with --inputs");
  }
  return roles;
}

std::string left_out_text(const Table& table, const Roles& given) {
  std::string text;
  if (!given.inputs.empty()) {
    return text;
  }
  const Header header(table);
  const Roles roles = guess_other_roles(table, header, given);
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (table.is_of_words(column) && header.can_be_input(table.names[column], roles)) {
      text +=
          fmt::format("{}:{}: {}: is left out of the inputs: '{}' is not a number\n", table.source,
                      table.texts[column].line, table.names[column], table.texts[column].cell);
    }
  }
  return text;
}

}  // namespace kelpie::log
