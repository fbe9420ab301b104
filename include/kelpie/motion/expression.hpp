// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/motion/unit.hpp"

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
/// Column names with other characters than letters, digits and underscores stand in single quotes.
class Expression {
 public:
  /// Operation of a step.
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

  /// One instruction of a stack machine: pops its operands and pushes the result.
  struct Step {
    Code code = Code::number;
    double number = 0.0;  ///< the number, or the exponent
    std::size_t column = 0;

    int operands() const;  ///< 0 to 2
  };

  /// A value and its derivative with respect to a column.
  struct Slope {
    double value = 0.0;
    double slope = 0.0;
  };

  /// `columns`: names in the order of the values in later calls. Throws InputError with the formula
  /// as field, the place of the error and the most similar column.
  static Expression parse(std::string_view text, std::span<const std::string> columns);

  const std::string& text() const { return text_; }

  /// The value at x. Requires a value for every column. Allocates nothing; thread-safe. Not finite
  /// after a division by zero, for example.
  double operator()(std::span<const double> x) const;

  /// The value and its right-hand derivative with respect to column k. At 0, |u| has the slope 1,
  /// max(u,0) 1, min(u,0) 0; sign has the slope 0 everywhere. Not finite if the value is not finite
  /// or the slope is unbounded (sqrt(u) at 0). Requires and allocates as above.
  Slope slope(std::span<const double> x, std::size_t k) const;

  /// The columns in the formula, each once, in ascending order.
  std::span<const std::size_t> columns() const { return columns_; }

  std::span<const Step> steps() const { return steps_; }

  /// The unit of the value from the units of all columns. Empty if undefined: a column without a
  /// unit, a sum of different units, the sine of a length. 0 has any unit, other numbers are
  /// dimensionless.
  std::optional<Unit> unit(std::span<const std::optional<Unit>> columns) const;

 private:
  friend class ExpressionParser;

  static constexpr std::size_t kDeepest = 16;

  template <typename Number, typename Column>
  Number run(Column column) const;

  std::string text_;
  std::vector<Step> steps_;
  std::vector<std::size_t> columns_;
};

}  // namespace kelpie
