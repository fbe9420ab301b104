// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/unit.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>

#include "core/angle.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "motion/text_scanner.hpp"

namespace kelpie {
namespace {

constexpr std::array kSpellings = std::to_array<std::pair<std::string_view, std::string_view>>(
    {{"⁻", "^-"}, {"¹", "1"}, {"²", "^2"}, {"³", "^3"}, {"·", "*"}, {"×", "*"}});

// A unit that is no unit of the SI.
struct Conversion {
  std::string_view name;
  std::string_view si;
  double factor;  // one such unit in units of the SI
};
constexpr double kKnot = 1852.0 / 3600.0;
constexpr std::array kMotion = std::to_array<Conversion>({{"deg", "rad", kRadPerDegree},
                                                          {"°", "rad", kRadPerDegree},
                                                          {"dps", "rad/s", kRadPerDegree},
                                                          {"mrad", "rad", 1e-3},
                                                          {"mm", "m", 1e-3},
                                                          {"cm", "m", 0.01},
                                                          {"km", "m", 1e3},
                                                          {"kn", "m/s", kKnot},
                                                          {"kt", "m/s", kKnot},
                                                          {"kts", "m/s", kKnot},
                                                          {"knot", "m/s", kKnot},
                                                          {"knots", "m/s", kKnot},
                                                          {"g", "m/s^2", 9.80665}});
constexpr std::array kTimes = std::to_array<Conversion>({{"min", "s", 60.0}, {"h", "s", 3600.0}});

// Names in words, as the symbols.
constexpr std::array kNames =
    std::to_array<std::pair<std::string_view, std::string_view>>({{"sec", "s"},
                                                                  {"secs", "s"},
                                                                  {"seconds", "s"},
                                                                  {"degree", "deg"},
                                                                  {"degrees", "deg"},
                                                                  {"radians", "rad"},
                                                                  {"meters", "m"},
                                                                  {"metres", "m"},
                                                                  {"RPM", "rpm"}});

// Superscripts and raised dots as they are typed on a keyboard.
std::string plain(std::string_view text) {
  std::string result(text);
  for (const auto& [from, to] : kSpellings) {
    for (std::size_t at = result.find(from); at != std::string::npos; at = result.find(from, at)) {
      const bool after_sign = at > 0 && result[at - 1] == '-';
      result.replace(at, from.size(), after_sign && to.starts_with('^') ? to.substr(1) : to);
    }
  }
  return result;
}

bool names(char letter) {
  const auto byte = static_cast<unsigned char>(letter);
  return std::isalpha(byte) != 0 || letter == '%' || byte >= 0x80U;
}

// unit  = power { ("*" | "/" | blank) power };  power = (name | "1" | "(" unit ")") [ "^" number ]
class UnitParser : TextScanner {
 public:
  // `plain_text` outlives the parser.
  UnitParser(std::string_view given, std::string_view plain_text)
      : TextScanner(plain_text), given_(given) {}

  Unit parse() {
    Unit unit = product(0);
    if (!at_end()) {
      fail("'" + std::string(1, text_[position_]) + "' is not expected");
    }
    return unit;
  }

 private:
  static constexpr int kDeepest = 20;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError("'" + printable(given_) + "' is not a unit such as m/s^2: " + what);
  }

  Unit product(int depth) {
    Unit unit = power(depth);
    while (!at_end() && text_[position_] != ')') {
      const bool divides = take('/');
      if (!divides) {
        take('*');
      }
      const Unit next = power(depth);
      unit = divides ? unit / next : unit * next;
    }
    return unit;
  }

  Unit power(int depth) {
    Unit base = operand(depth);
    if (!take('^')) {
      return base;
    }
    const std::optional<double> exponent = take_number();
    if (!exponent) {
      fail("a number has to follow '^'");
    }
    return base.power(*exponent);
  }

  Unit operand(int depth) {
    if (at_end()) {
      fail("it ends where a name is expected");
    }
    if (depth < kDeepest && take('(')) {
      Unit unit = product(depth + 1);
      if (!take(')')) {
        fail("')' is missing");
      }
      return unit;
    }
    if (take('1')) {
      return {};
    }
    return name();
  }

  Unit name() {
    const std::size_t start = position_;
    while (position_ < text_.size() && names(text_[position_])) {
      ++position_;
    }
    if (position_ == start) {
      fail("'" + std::string(1, text_[position_]) + "' is not expected");
    }
    if (position_ < text_.size() &&
        std::isdigit(static_cast<unsigned char>(text_[position_])) != 0) {
      fail("a power is written with '^'");
    }
    const std::string_view given = text_.substr(start, position_ - start);
    const auto* const word =
        std::ranges::find(kNames, given, &std::pair<std::string_view, std::string_view>::first);
    return Unit::named(std::string(word == kNames.end() ? given : word->second));
  }

  std::string given_;
};

}  // namespace

Unit Unit::parse(std::string_view text) {
  const std::string plain_text = plain(text);
  return UnitParser(text, plain_text).parse();
}

Unit Unit::named(std::string name) {
  Unit unit;
  unit.powers_.emplace_back(std::move(name), 1.0);
  return unit;
}

Unit Unit::operator*(const Unit& other) const {
  Unit product = *this;
  for (const auto& [name, exponent] : other.powers_) {
    const auto place = std::ranges::lower_bound(
        product.powers_, name, {}, [](const auto& power) -> const auto& { return power.first; });
    if (place == product.powers_.end() || place->first != name) {
      product.powers_.insert(place, {name, exponent});
    } else {
      place->second += exponent;
    }
  }
  std::erase_if(product.powers_, [](const auto& power) { return power.second == 0.0; });
  return product;
}

Unit Unit::power(double exponent) const {
  Unit result = *this;
  for (auto& [name, own] : result.powers_) {
    own *= exponent;
  }
  std::erase_if(result.powers_, [](const auto& power) { return power.second == 0.0; });
  return result;
}

std::pair<Unit, double> Unit::in_si() const {
  const auto is_of_motion = [](const auto& power) {
    return power.first == "m" || power.first == "rad" ||
           std::ranges::find(kMotion, power.first, &Conversion::name) != kMotion.end();
  };
  if (std::ranges::none_of(powers_, is_of_motion)) {
    return {*this, 1.0};
  }
  Unit unit;
  double factor = 1.0;
  for (const auto& [name, exponent] : powers_) {
    Unit si = named(name);
    for (const std::span<const Conversion> table :
         {std::span<const Conversion>(kMotion), std::span<const Conversion>(kTimes)}) {
      const auto found = std::ranges::find(table, name, &Conversion::name);
      if (found != table.end()) {
        si = parse(found->si);
        factor *= std::pow(found->factor, exponent);
      }
    }
    unit = unit * si.power(exponent);
  }
  return {unit, factor};
}

std::string Unit::text() const {
  std::string text;
  for (const bool positive : {true, false}) {
    for (const auto& [name, exponent] : powers_) {
      if ((exponent > 0.0) == positive) {
        text += (text.empty() ? "" : " ") + name;
        text += exponent == 1.0 ? "" : "^" + number_text(exponent);
      }
    }
  }
  return text.empty() ? "1" : text;
}

}  // namespace kelpie
