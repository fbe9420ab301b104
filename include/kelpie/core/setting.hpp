// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "kelpie/core/error.hpp"

namespace kelpie {

/// Shortest decimal text of a number that reads back equal.
std::string number_text(double value);

/// Reads a number for the setting `name`; throws InputError with the text on other text.
double number_setting(std::string_view name, std::string_view text);

/// Index of `text` among `choices`; throws InputError with the choices on other text.
int choice_setting(std::string_view name, std::string_view text,
                   std::span<const std::string_view> choices);

/// A range of numbers: [low, high], without `low` itself when `open`.
struct Range {
  double low = -HUGE_VAL;
  double high = HUGE_VAL;
  bool open = false;

  /// Whether a value is in the range.
  bool holds(double value) const {  // false for NaN and infinity
    return std::isfinite(value) && (open ? value > low : value >= low) && value <= high;
  }
  std::string text() const;  ///< "> 0", ">= 0", "0 to 1", "more than 0, up to 1"
};

/// Throws InputError about `field`, with range and unit, on a value out of range.
void require_range(std::string_view field, double value, const Range& range,
                   const std::string& unit = {});

/// The condition that leaves a setting without effect: certain values (separated by commas) of
/// another setting; or a condition that is no setting, without values.
struct IdleCondition {
  std::string_view with = {};
  std::string_view values = {};

  std::string text(std::string_view value) const;  ///< "with forget = fifo"; no value: "with …"
};

/// The group of the most used settings.
constexpr std::string_view kEssential = "Essential";

/// One field of a settings struct T, for config files, command line, checks and documentation. The
/// fields of a struct stand in one table.
template <typename T>
struct Setting {
  /// An enumeration, by the names of its values.
  struct Choice {
    int (*get)(const T&);
    void (*set)(T&, int);
    std::span<const std::string_view> names;
  };

  /// Free text.
  struct Text {
    std::string T::*member;
    std::string_view allowed;  ///< in words; checked by the reader of the text
  };

  std::string_view name;
  std::string_view meaning;  ///< one line for people, with unit and equation
  std::variant<double T::*, int T::*, Choice, Text> member;
  Range range = {};             ///< of numbers
  std::string_view group = {};  ///< heading in documentation
  IdleCondition idle = {};

  /// The value as text, in the form of assign().
  std::string get(const T& settings) const {
    if (const auto* const choice = std::get_if<Choice>(&member)) {
      return std::string(choice->names[static_cast<std::size_t>(choice->get(settings))]);
    }
    if (const auto* const words = std::get_if<Text>(&member)) {
      return settings.*(words->member);
    }
    return number_text(number(settings));
  }

  /// Sets the field from text. Throws InputError naming the field and valid values; check() checks
  /// the range.
  void assign(T& settings, std::string_view text) const {
    if (const auto* const choice = std::get_if<Choice>(&member)) {
      choice->set(settings, choice_setting(name, text, choice->names));
      return;
    }
    if (const auto* const words = std::get_if<Text>(&member)) {
      settings.*(words->member) = std::string(text);
      return;
    }
    const double value = number_setting(name, text);
    if (const auto* const real = std::get_if<double T::*>(&member)) {
      settings.** real = value;
      return;
    }
    if (value != std::floor(value) || std::abs(value) > 1e9) {
      throw InputError(std::string(name), "'" + std::string(text) + "' is not a whole number");
    }
    settings.*std::get<int T::*>(member) = static_cast<int>(value);
  }

  /// Throws InputError naming the field on a number out of range.
  void check(const T& settings) const {
    if (!std::holds_alternative<Choice>(member) && !std::holds_alternative<Text>(member)) {
      require_range(name, number(settings), range);
    }
  }

  /// Valid values: the choices or the range.
  std::string allowed() const;

 private:
  double number(const T& settings) const {
    if (const auto* const real = std::get_if<double T::*>(&member)) {
      return settings.**real;
    }
    return settings.*std::get<int T::*>(member);
  }
};

template <typename T>
std::string Setting<T>::allowed() const {
  if (const auto* const choice = std::get_if<Choice>(&member)) {
    std::string text;
    for (const std::string_view choice_name : choice->names) {
      text += (text.empty() ? "" : ", ") + std::string(choice_name);
    }
    return text;
  }
  if (const auto* const words = std::get_if<Text>(&member)) {
    return std::string(words->allowed);
  }
  return (std::holds_alternative<int T::*>(member) ? "whole number, " : "") + range.text();
}

/// A Choice for an enumeration whose values count 0, 1, 2 … in the order of `names`.
template <auto Member, typename T>
constexpr typename Setting<T>::Choice choice_of(std::span<const std::string_view> names) {
  using Enum = std::remove_cvref_t<decltype(std::declval<T>().*Member)>;
  return {[](const T& settings) { return static_cast<int>(settings.*Member); },
          [](T& settings, int value) { settings.*Member = static_cast<Enum>(value); }, names};
}

}  // namespace kelpie
