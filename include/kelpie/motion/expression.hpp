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
/// A column that isn't a plain word (letters, digits, underscores) is put in single quotes.
class Expression {
 public:
  /// What one step does.
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

  /// The formula is kept for a stack machine: every step takes its operands from the top of the
  /// stack and leaves one value there.
  struct Step {
    Code code = Code::number;
    double number = 0.0;  ///< the number, or the exponent
    std::size_t column = 0;

    int operands() const;  ///< 0 to 2
  };

  /// A value and its derivative by one column.
  struct Slope {
    double value = 0.0;
    double slope = 0.0;
  };

  /// Throws InputError with the formula as field, saying what is wrong, where, and which column was
  /// probably meant. `columns` gives the order in which values are handed over.
  static Expression parse(std::string_view text, std::span<const std::string> columns);

  const std::string& text() const { return text_; }

  /// Requires a value for every column. Allocates nothing; safe from many threads. Not finite where
  /// the formula isn't (a division by zero, say).
  double operator()(std::span<const double> x) const;

  /// The value and its derivative by column k, to the right: as the column grows. So |u| has the
  /// slope 1 at 0, max(u,0) 1, min(u,0) 0; sign has the slope 0 everywhere. Not finite where the
  /// formula isn't, or the slope has no bound (sqrt(u) at 0). Requires and allocates as above.
  Slope slope(std::span<const double> x, std::size_t k) const;

  /// The columns it uses, each once, in their order.
  std::span<const std::size_t> columns() const { return columns_; }

  std::span<const Step> steps() const { return steps_; }

  /// The unit of the value, given those of all columns. Nothing where it can't be told: a column
  /// without one, a sum of different units, the sine of a length. 0 is of any unit, other numbers
  /// are plain.
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
