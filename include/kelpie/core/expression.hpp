// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/core/unit.hpp"

namespace kelpie {

/// A formula over the columns of a sample, such as `u*r`, `th1*|th1|` or `max(th1,0)^2`.
///
///     sum      = product { ("+" | "-") product }
///     product  = power { ("*" | "/") power }
///     power    = operand [ "^" number ]               a number >= 0; binds closer than a minus
///     operand  = "-" power | number | column | "(" sum ")" | "|" sum "|"
///              | function "(" sum { "," sum } ")"
///     function = abs | sign | sqrt | sin | cos | tanh | min | max
///
/// A column that isn't a plain word (letters, digits, underscores) is put in single quotes.
class Expression {
 public:
  /// Throws InputError with the formula as field, saying what is wrong, where, and which column was
  /// probably meant. `columns` gives the order in which values are handed over.
  static Expression parse(std::string_view text, std::span<const std::string> columns);

  const std::string& text() const { return text_; }

  /// Requires a value for every column. Allocates nothing; safe from many threads. Not finite where
  /// the formula isn't (a division by zero, say).
  double operator()(std::span<const double> x) const;

  /// The unit of the value, given those of all columns. Nothing where it can't be told: a column
  /// without one, a sum of different units, the sine of a length. 0 is of any unit, other numbers
  /// are plain.
  std::optional<Unit> unit(std::span<const std::optional<Unit>> columns) const;

 private:
  friend class ExpressionParser;

  enum class Code : std::uint8_t {
    number,
    column,
    add,
    subtract,
    multiply,
    divide,
    power,
    negate,
    abs,
    sign,
    sqrt,
    sin,
    cos,
    tanh,
    min,
    max
  };
  struct Step {  ///< of a stack machine
    Code code = Code::number;
    double number = 0.0;  ///< the number, or the exponent
    std::size_t column = 0;
  };
  static constexpr std::size_t kDeepest = 16;

  std::string text_;
  std::vector<Step> steps_;
};

}  // namespace kelpie
