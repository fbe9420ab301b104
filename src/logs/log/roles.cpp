// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/scaling.hpp"
#include "log/dataset.hpp"
#include "log/known_roles.hpp"
#include "log/pair_moments.hpp"
#include "motion/states.hpp"

namespace kelpie::log {
namespace {

constexpr std::array<std::string_view, 2> kConfigurations{"conf", "configuration"};
constexpr std::string_view kSplit = "split";
constexpr std::array<std::string_view, 5> kHeadingOfVehicle{"psi", "yaw", "heading", "hdg",
                                                            "compass"};
constexpr std::array<std::string_view, 3> kAngleEndings{"", "_deg", "_rad"};
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

// "u" of "u [furlongs]", whose unit is unknown; "v[0]" is a name.
std::string_view without_unit(std::string_view name) {
  const std::size_t bracket = name.find_last_of("[(");
  const bool has_one = bracket != std::string_view::npos && bracket > 0 &&
                       (name.ends_with(']') || name.ends_with(')'));
  const bool is_index = has_one && name[bracket + 1] >= '0' && name[bracket + 1] <= '9';
  return has_one && !is_index ? trimmed(name.substr(0, bracket)) : name;
}

// What the names of a table's columns tell of each other.
class Header {
 public:
  explicit Header(const Table& table)
      : table_(table), names_(table.names.begin(), table.names.end()) {
    std::ranges::transform(table.names, std::inserter(names_, names_.end()), without_unit);
    for (std::size_t column = 0; column < table.texts.size(); ++column) {
      if (table.is_time(column)) {
        stamps_.insert(table.names[column]);
      }
    }
  }

  [[noreturn]] void refuse(const std::string& part, const std::string& message) const {
    throw InputError({.file = table_.source, .field = part}, message + "; " + columns_text(table_));
  }

  // "dr" beside rdot is a rudder.
  bool is_acceleration(std::string_view name) const {
    const std::string_view whole = without_unit(name);
    return std::ranges::any_of(differentiated(whole), [&](std::string_view stem) {
      const bool is_other = whole.ends_with(stem) && has_dotted(stem);
      return is_quantity(stem) && !is_other;
    });
  }

  // Whether it would be an input if it holds numbers.
  bool can_be_input(const std::string& name, const Roles& roles) const {
    const bool has_part = is_stamp(name) || is_among(name, roles.targets) || name == roles.time ||
                          name == roles.configuration || name == roles.held_out ||
                          is_among(name, kTimeNames) || is_among(name, kConfigurations) ||
                          name == kSplit;
    return !has_part && !is_acceleration(name) && !is_true_value(name);
  }

  // Whether it would be a target if it varies.
  bool may_be_target(const std::string& name, const Roles& given) const {
    return given.targets.empty() && is_acceleration(name) && !is_among(name, given.inputs) &&
           !is_among(name, given.ignored);
  }

  bool is_stamp(std::string_view name) const { return stamps_.contains(name); }

 private:
  // Whether `stem` is a column that another can be named after: "dt" beside "t" is no acceleration.
  bool is_quantity(std::string_view stem) const {
    return names_.contains(stem) && !is_among(stem, kTimeNames);
  }
  bool has_dotted(std::string_view stem) const {
    return std::ranges::any_of(names_, [&](std::string_view name) {
      return name.starts_with(stem) &&
             (name.substr(stem.size()) == "dot" || name.substr(stem.size()) == "_dot");
    });
  }
  // As kelpie simulates it.
  bool is_true_value(std::string_view name) const {
    constexpr std::string_view kTrue = "_true";
    return name.ends_with(kTrue) && is_quantity(name.substr(0, name.size() - kTrue.size()));
  }

  const Table& table_;
  std::unordered_set<std::string_view> names_;
  std::unordered_set<std::string_view> stamps_;
};

// Whether a target is the derivative of the column.
bool is_state(std::string_view name, const Roles& roles) {
  return std::ranges::any_of(roles.targets, [&](const std::string& target) {
    return is_among(name, differentiated(without_unit(target)));
  });
}

// Of "true_u" and "u_next" beside u, why they are no inputs.
std::string reason_by_affix(const Table& table, const std::string& name) {
  const std::size_t first = name.find('_');
  const std::size_t last = name.rfind('_');
  if (first == std::string::npos) {
    return "";
  }
  for (const KnownAffix& affix : known_affixes()) {
    const std::vector<std::string> words = split_text(std::string(affix.words), ' ');
    for (const auto& [word, rest] : {std::pair(name.substr(0, first), name.substr(first + 1)),
                                     std::pair(name.substr(last + 1), name.substr(0, last))}) {
      if (is_among(word, words) && is_among(rest, table.names)) {
        return fmt::format(fmt::runtime(affix.why), rest);
      }
    }
  }
  return "";
}

// Targets and their velocities.
std::vector<KnownColumn> motion_of(const Table& table, const Roles& roles) {
  std::vector<KnownColumn> motion;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    const std::string& name = table.names[column];
    const bool is_target = is_among(name, roles.targets);
    if (is_target || is_state(name, roles)) {
      motion.push_back({name, values_of(table, column), is_target});
    }
  }
  return motion;
}

// A name such as rpm1 or thr_ref_2 taken apart.
struct NumberedName {
  enum class Use { command, force, demand };

  std::string stem;    // "rpm"
  std::string number;  // "1"; "" without one
  std::optional<CommandWords::Kind> kind;
  Use use = Use::command;
};
using Use = NumberedName::Use;

NumberedName numbered(const std::string& name) {
  constexpr std::string_view kForces = "fx# fy# fz# mx# my# mz# tx# ty# tz# force# torque#";
  NumberedName parts;
  for (const std::string& word : words_of(name)) {
    const std::size_t letters = word.find_last_not_of("0123456789") + 1;
    parts.stem += word.substr(0, letters) + " ";
    parts.number += word.substr(letters);
    parts.use = is_demand_word(word)            ? Use::demand
                : is_among_words(kForces, word) ? Use::force
                                                : parts.use;
    for (const CommandWords& known : known_command_words()) {
      if (is_among_words(known.words, word)) {
        parts.kind = known.kind;
      }
    }
  }
  return parts;
}

// Columns of the same kind of command, of several thrusters.
struct NumberedSet {
  NumberedName name;
  std::vector<std::string> numbers{};
  std::vector<std::size_t> columns{};
};

std::vector<NumberedSet> numbered_sets(const Table& table, const std::vector<std::string>& inputs) {
  std::vector<NumberedSet> sets;
  for (const std::string& input : inputs) {
    const NumberedName parts = numbered(input);
    if (parts.number.empty() || velocity_by_name(input) || measured_pose_part(input)) {
      continue;
    }
    auto set = std::ranges::find_if(
        sets, [&](const NumberedSet& one) { return one.name.stem == parts.stem; });
    if (set == sets.end()) {
      set = sets.insert(sets.end(), {.name = parts});
    }
    set->numbers.push_back(parts.number);
    set->columns.push_back(table.find(input));
  }
  return sets;
}

// Whether two sets go with each other thruster by thruster, as pulses with the speeds of rotors.
bool go_together(const Table& table, const NumberedSet& a, const NumberedSet& b) {
  constexpr double kTogether = 0.8;  // correlation, by hand
  for (std::size_t k = 0; k < a.columns.size(); ++k) {
    PairMoments moments;
    const std::span<const double> x = values_of(table, a.columns[k]);
    const std::span<const double> y = values_of(table, b.columns[k]);
    for (std::size_t row = 0; row < x.size(); ++row) {
      moments.add(x[row], y[row]);
    }
    if (std::abs(moments.correlation()) < kTogether) {
      return false;
    }
  }
  return !values_of(table, a.columns.front()).empty();
}

// The set that tells of the same thrusters what `set` tells, and is taken in its place; or null.
// Forces along the axes go before the speeds and angles of azimuth thrusters, of which they are
// made; else commands go before forces, and before demands in any case.
const NumberedSet* taken_in_place_of(const Table& table, const NumberedSet& set,
                                     const std::vector<NumberedSet>& sets) {
  std::vector<const NumberedSet*> alike;
  for (const NumberedSet& other : sets) {
    if (other.numbers == set.numbers && set.numbers.size() > 1) {
      alike.push_back(&other);
    }
  }
  const auto find = [&](auto is_one) {
    const auto found = std::ranges::find_if(alike, is_one);
    return found == alike.end() ? nullptr : *found;
  };
  const bool has_angles = find([](const NumberedSet* one) {
                            return one->name.kind == CommandWords::Kind::angle;
                          }) != nullptr;
  const auto taken = [&](Use use) {
    return find([&](const NumberedSet* one) {
      return one->name.use == use && (use == Use::force || one->name.kind);
    });
  };
  const NumberedSet* const forces = has_angles ? taken(Use::force) : nullptr;
  const NumberedSet* const first = forces != nullptr ? forces : taken(Use::command);
  if (first == nullptr) {
    return nullptr;
  }
  if (set.name.use != first->name.use) {
    return first;
  }
  return find([&](const NumberedSet* one) {
    return one->columns.front() < set.columns.front() && one->name.kind &&
           one->name.kind == set.name.kind && go_together(table, *one, set);
  });
}

// Why a column that could be an input is left out of the guessed inputs; empty: an input.
// `roles`: with the inputs so far; `motion`: motion_of().
std::string reason_against(const Table& table, std::size_t column, const Roles& roles,
                           const std::vector<KnownColumn>& motion) {
  const std::string& name = table.names[column];
  if (is_among(name, roles.ignored)) {
    return "ignored, as asked";
  }
  if (is_among(name, roles.also)) {
    return "";
  }
  const std::span<const double> values = values_of(table, column);
  if (table.is_of_words(column)) {
    return fmt::format("'{}' is not a number", table.texts[column].cell);
  }
  if (counts_rows(values)) {
    return "a counter";
  }
  const bool is_velocity = is_state(name, roles);
  if (std::string why = why_no_input(name); !why.empty() && !is_velocity) {
    return why;
  }
  for (const std::string& why : {reason_by_affix(table, name),
                                 is_velocity ? "" : near_copy_of({name, values, false}, motion)}) {
    if (!why.empty()) {
      return why + "; --inputs takes it";
    }
  }
  if (is_constant(values)) {
    return fmt::format("{} in every row", values.front());
  }
  for (const std::string& earlier : roles.inputs) {
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

// Takes second sets for the same thrusters out of the inputs.
void drop_second_sets(const Table& table, Roles& roles, std::vector<LeftOut>& left_out) {
  const std::vector<NumberedSet> sets = numbered_sets(table, roles.inputs);
  for (const NumberedSet& set : sets) {
    const NumberedSet* const taken = taken_in_place_of(table, set, sets);
    for (const std::size_t column : taken == nullptr ? std::vector<std::size_t>{} : set.columns) {
      const std::string& name = table.names[column];
      if (!is_among(name, roles.also)) {
        std::erase(roles.inputs, name);
        left_out.push_back({column, "a second set for the thrusters of " +
                                        table.names[taken->columns.front()] +
                                        "; --inputs takes it"});
      }
    }
  }
}

// Adds the columns that are inputs to the roles. Returns the others that could be.
std::vector<LeftOut> add_inputs(const Table& table, const Header& header, Roles& roles) {
  std::vector<LeftOut> left_out;
  const std::vector<KnownColumn> motion = motion_of(table, roles);
  constexpr std::size_t kEnough =
      std::size_t{8} * kMostInputs;  // however many of them are second sets
  for (std::size_t column = 0; column < table.names.size() && roles.inputs.size() < kEnough;
       ++column) {
    if (!header.can_be_input(table.names[column], roles)) {
      continue;
    }
    const std::string reason = reason_against(table, column, roles, motion);
    if (!reason.empty()) {
      left_out.push_back({column, reason});
      continue;
    }
    roles.inputs.push_back(table.names[column]);
  }
  drop_second_sets(table, roles, left_out);
  if (roles.inputs.size() > kMostInputs) {
    header.refuse("inputs", fmt::format("more than {} columns are left for them, which no model "
                                        "takes; name them with --inputs",
                                        kMostInputs));
  }
  return left_out;
}

// Velocities stand first, in the order of their axes within the log.
void put_velocities_first(std::vector<std::string>& inputs) {
  std::ranges::stable_partition(
      inputs, [](const std::string& name) { return velocity_axis(name).has_value(); });
}

void check_ignored(const Table& table, const Roles& given) {
  for (const std::string& name : given.ignored) {
    table.find(name);
    if (is_among(name, given.inputs) || is_among(name, given.targets)) {
      throw InputError({.file = table.source, .field = name},
                       "is both to be ignored and named among the inputs or targets");
    }
  }
}

// All parts but the inputs.
Roles guess_other_roles(const Table& table, const Header& header, const Roles& given) {
  Roles roles = given;
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    const std::string& name = table.names[column];
    if (roles.configuration.empty() && is_among(name, kConfigurations)) {
      roles.configuration = name;
    }
    if (header.may_be_target(name, given) && !is_constant(values_of(table, column))) {
      roles.targets.push_back(name);
    }
  }
  roles.time = usual_time(table, given);
  return roles;
}

}  // namespace

std::string near_copy_of(const KnownColumn& column, const std::vector<KnownColumn>& motion) {
  constexpr double kNearCopy = 0.98;  // correlation, by hand
  constexpr double kNearTarget =
      0.995;  // a force of a vehicle without much drag comes near; by hand
  constexpr std::ptrdiff_t kMostShift = 3;
  constexpr std::ptrdiff_t kFewRows = 100;
  const std::optional<std::string> part = measured_pose_part(column.name);
  const std::vector<std::string> words = words_of(column.name);
  if (std::ranges::any_of(words, is_command_word) || velocity_by_name(column.name) ||
      part == "roll" || part == "pitch" || std::ssize(column.values) < kFewRows) {
    return "";
  }
  std::string copied;
  double best = 0.0;
  for (const KnownColumn& known : motion) {
    for (std::ptrdiff_t shift = -kMostShift; shift <= kMostShift; ++shift) {
      PairMoments moments;
      for (std::ptrdiff_t row = kMostShift; row + kMostShift < std::ssize(column.values); ++row) {
        moments.add(column.values[static_cast<std::size_t>(row)],
                    known.values[static_cast<std::size_t>(row + shift)]);
      }
      const double least = known.is_target ? kNearTarget : kNearCopy;
      if (std::abs(moments.correlation()) > std::max(best, least)) {
        best = std::abs(moments.correlation());
        copied =
            fmt::format("goes with {}, read {} rows {}: correlation {:.3f}", known.name,
                        std::abs(shift), shift < 0 ? "earlier" : "later", moments.correlation());
      }
    }
  }
  return copied;
}

std::string usual_time(const Table& table, const Roles& given) {
  if (!given.time.empty() || given.rate_hz > 0.0) {
    return given.time;
  }
  for (const std::string& name : table.names) {
    if (is_among(name, kTimeNames)) {
      return name;
    }
  }
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (table.is_time(column)) {
      return table.names[column];
    }
  }
  return {};
}

Roles guess_roles(const Table& table, const Roles& given) {
  check_ignored(table, given);
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
  for (const std::string& name : given.also) {
    table.find(name);
    if (!is_among(name, roles.inputs)) {
      roles.inputs.push_back(name);
    }
  }
  return roles;
}

std::string find_heading(const Table& table) {
  for (const std::string_view name : kHeadingOfVehicle) {
    for (const std::string_view ending : kAngleEndings) {
      const auto found = std::ranges::find(table.names, std::string(name) + std::string(ending));
      const auto column = static_cast<std::size_t>(found - table.names.begin());
      if (found != table.names.end() && !table.has_text(column)) {
        return *found;
      }
    }
  }
  return "";
}

Roles without_constants(const Table& table, Roles roles) {
  const auto varies = [&](const std::string& name) {
    const auto found = std::ranges::find(table.names, name);
    return found == table.names.end() ||
           !is_constant(values_of(table, static_cast<std::size_t>(found - table.names.begin())));
  };
  if (std::ranges::any_of(roles.inputs, varies)) {
    std::erase_if(roles.inputs, [&](const std::string& name) { return !varies(name); });
  }
  return roles;
}

std::string left_out_text(const Table& table, const Roles& given) {
  std::string text;
  const auto add = [&](std::size_t column, const char* part, const std::string& reason) {
    const std::string line =
        table.has_text(column) ? fmt::format(":{}", table.texts[column].line) : "";
    text += fmt::format("{}{}: {}: is left out of the {}: {}\n", table.source, line,
                        table.names[column], part, reason);
  };
  const auto constant = [&](std::size_t column) {
    return fmt::format("{} in every row", table.columns[column].front());
  };
  const Header header(table);
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (header.may_be_target(table.names[column], given) && is_constant(values_of(table, column))) {
      add(column, "targets", constant(column));
    }
  }
  if (given.inputs.empty()) {
    Roles roles = guess_other_roles(table, header, given);
    for (const LeftOut& one : add_inputs(table, header, roles)) {
      add(one.column, "inputs", one.reason);
    }
    return text;
  }
  const Roles varying = without_constants(table, given);
  for (const std::string& name : given.inputs) {
    if (!is_among(name, varying.inputs)) {
      const std::size_t column = table.find(name);
      add(column, "inputs", constant(column));
    }
  }
  return text;
}

}  // namespace kelpie::log
