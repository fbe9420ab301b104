// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/expression.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "motion/text_scanner.hpp"

namespace kelpie {

class ExpressionParser : TextScanner {
 public:
  ExpressionParser(std::string_view text, std::span<const std::string> columns)
      : TextScanner(text), columns_(columns) {}

  Expression parse() {
    sum();
    if (!at_end()) {
      fail("'" + std::string(1, text_[position_]) + "' is not expected here");
    }
    result_.text_ = std::string(text_);
    for (const Expression::Step& step : result_.steps_) {
      if (step.code == Code::column) {
        result_.columns_.push_back(step.column);
      }
    }
    std::ranges::sort(result_.columns_);
    const auto repeated = std::ranges::unique(result_.columns_);
    result_.columns_.erase(repeated.begin(), repeated.end());
    return std::move(result_);
  }

 private:
  using Code = Expression::Code;

  struct Function {
    std::string_view name;
    Code code;
    int arguments;
  };
  static constexpr std::array kFunctions = std::to_array<Function>({
      {"abs", Code::abs, 1},
      {"sign", Code::sign, 1},
      {"sqrt", Code::sqrt, 1},
      {"sin", Code::sin, 1},
      {"cos", Code::cos, 1},
      {"tanh", Code::tanh, 1},
      {"min", Code::min, 2},
      {"max", Code::max, 2},
  });

  [[noreturn]] void fail(const std::string& what) const {
    constexpr std::size_t kShown = 190;
    throw InputError("'" + printable(text_, kShown) + "'",
                     what + " (at character " + std::to_string(position_ + 1) + ")");
  }

  void expect(char wanted) {
    if (!take(wanted)) {
      fail(std::string("'") + wanted + "' is missing");
    }
  }

  void emit(Code code, double number = 0.0, std::size_t column = 0) {
    result_.steps_.push_back({code, number, column});
    if (result_.steps_.size() > kMostSteps) {
      fail("has more than " + std::to_string(kMostSteps) + " columns, numbers and operations");
    }
    depth_ += 1 - result_.steps_.back().operands();
    if (depth_ > static_cast<int>(Expression::kDeepest)) {
      fail("is nested too deeply");
    }
  }

  void sum() {
    if (++nesting_ > kMostNested) {
      fail("is nested too deeply");
    }
    product();
    while (true) {
      if (take('+')) {
        product();
        emit(Code::add);
      } else if (take('-')) {
        product();
        emit(Code::subtract);
      } else {
        --nesting_;
        return;
      }
    }
  }

  void product() {
    power();
    while (true) {
      if (take('*')) {
        power();
        emit(Code::multiply);
      } else if (take('/')) {
        power();
        emit(Code::divide);
      } else {
        return;
      }
    }
  }

  void power() {
    if (take('-')) {
      if (++nesting_ > kMostNested) {
        fail("is nested too deeply");
      }
      power();
      emit(Code::negate);
      --nesting_;
      return;
    }
    operand();
    if (take('^')) {
      at_end();  // skips spaces
      emit(Code::power, number());
    }
  }

  void operand() {
    if (at_end()) {
      fail("ends where a column or number is expected");
    }
    const char first = text_[position_];
    if (take('(')) {
      sum();
      expect(')');
    } else if (take('|')) {
      sum();
      expect('|');
      emit(Code::abs);
    } else if (take('\'')) {
      const std::size_t begin = position_;
      const std::string name = quoted_name();
      const std::size_t end = std::exchange(position_, begin);  // what is wrong stands there
      column(name);
      position_ = end;
    } else if (std::isdigit(static_cast<unsigned char>(first)) != 0 || first == '.') {
      emit(Code::number, number());
    } else {
      word();
    }
  }

  // Behind the first quote, up to the last one. A quote of the name stands twice.
  std::string quoted_name() {
    std::string name;
    while (true) {
      const std::size_t end = text_.find('\'', position_);
      if (end == std::string_view::npos) {
        fail("a quote is not closed");
      }
      name += text_.substr(position_, end - position_);
      position_ = end + 1;
      if (!text_.substr(position_).starts_with('\'')) {
        return name;
      }
      name += text_[position_++];
    }
  }

  double number() {
    const std::size_t start = position_;
    const std::optional<double> value = take_number();
    if (!value || *value < 0.0) {
      position_ = start;
      fail("a number >= 0 is expected");
    }
    return *value;
  }

  void word() {
    std::size_t end = position_;
    while (end < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[end])) != 0 || text_[end] == '_')) {
      ++end;
    }
    if (end == position_) {
      fail("'" + std::string(1, text_[position_]) + "' is not expected here");
    }
    const std::string_view name = text_.substr(position_, end - position_);
    const auto* const function = std::ranges::find(kFunctions, name, &Function::name);
    if (function == kFunctions.end() || end == text_.size() || text_[end] != '(') {
      column(name);
      position_ = end;
      return;
    }
    position_ = end + 1;
    sum();
    for (int argument = 1; argument < function->arguments; ++argument) {
      expect(',');
      sum();
    }
    expect(')');
    emit(function->code);
  }

  void column(std::string_view name) {
    const auto found = std::ranges::find(columns_, name);
    if (found == columns_.end()) {
      const std::vector<std::string> known(columns_.begin(), columns_.end());
      fail(unknown_name(name, "column", known));
    }
    emit(Code::column, 0.0, static_cast<std::size_t>(found - columns_.begin()));
  }

  static constexpr int kMostNested = 100;
  static constexpr std::size_t kMostSteps = 500;

  std::span<const std::string> columns_;
  int depth_ = 0;
  int nesting_ = 0;
  Expression result_;
};

Expression Expression::parse(std::string_view text, std::span<const std::string> columns) {
  return ExpressionParser(text, columns).parse();
}

namespace {

using Code = Expression::Code;
using Slope = Expression::Slope;

double applied(const Expression::Step& step, double x) {
  switch (step.code) {
    case Code::power:
      return step.number == 2.0 ? x * x : std::pow(x, step.number);
    case Code::negate:
      return -x;
    case Code::abs:
      return std::abs(x);
    case Code::sign:
      return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0);
    case Code::sqrt:
      return std::sqrt(x);
    case Code::sin:
      return std::sin(x);
    case Code::cos:
      return std::cos(x);
    default:
      return std::tanh(x);
  }
}

double applied(const Expression::Step& step, double left, double right) {
  switch (step.code) {
    case Code::add:
      return left + right;
    case Code::subtract:
      return left - right;
    case Code::multiply:
      return left * right;
    case Code::divide:
      return left / right;
    case Code::min:
      return std::min(left, right);
    default:
      return std::max(left, right);
  }
}

// The derivative of a function of one value at x, where it has one.
double slope_of(const Expression::Step& step, double x, double value) {
  switch (step.code) {
    case Code::power:
      if (step.number == 0.0) {
        return 0.0;
      }
      return step.number * (step.number == 2.0 ? x : std::pow(x, step.number - 1.0));
    case Code::negate:
      return -1.0;
    case Code::sqrt:
      return 0.5 / value;
    case Code::sin:
      return std::cos(x);
    case Code::cos:
      return -std::sin(x);
    case Code::tanh:
      return 1.0 - value * value;
    default:
      return 0.0;  // sign
  }
}

Slope applied(const Expression::Step& step, const Slope& x) {
  if (step.code == Code::abs) {
    const double slope = x.value > 0.0 ? x.slope : (x.value < 0.0 ? -x.slope : std::abs(x.slope));
    return {std::abs(x.value), slope};
  }
  const double value = applied(step, x.value);
  // What doesn't move has no slope, however steep the function is there.
  return {value, x.slope == 0.0 ? 0.0 : slope_of(step, x.value, value) * x.slope};
}

Slope applied(const Expression::Step& step, const Slope& left, const Slope& right) {
  const double value = applied(step, left.value, right.value);
  switch (step.code) {
    case Code::add:
      return {value, left.slope + right.slope};
    case Code::subtract:
      return {value, left.slope - right.slope};
    case Code::multiply:
      return {value, left.slope * right.value + left.value * right.slope};
    case Code::divide:
      return {value, (left.slope - value * right.slope) / right.value};
    default:
      break;
  }
  // Of two that are equal, the one that will be less, or greater, in a moment.
  if (left.value == right.value) {
    return {value, applied(step, left.slope, right.slope)};
  }
  return {value, value == left.value ? left.slope : right.slope};
}

// The unit of a value, if it has one; a zero has every unit.
struct Known {
  std::optional<Unit> unit;
  bool zero = false;
};

Known product(const Known& left, const Known& right, bool divided) {
  if (!left.unit || !right.unit) {
    return {};
  }
  return {divided ? *left.unit / *right.unit : *left.unit * *right.unit};
}

// Of a sum, a least or a greatest.
Known common(const Known& left, const Known& right) {
  if (left.zero || right.zero) {
    return left.zero ? right : left;
  }
  return left.unit == right.unit ? left : Known{};
}

Known plain_of_plain(const Known& value) {
  return value.unit == Unit{} ? value : Known{};
}

Known power(const Known& value, double exponent) {
  return value.unit ? Known{value.unit->power(exponent)} : Known{};
}

}  // namespace

int Expression::Step::operands() const {
  switch (code) {
    case Code::number:
    case Code::column:
      return 0;
    case Code::add:
    case Code::subtract:
    case Code::multiply:
    case Code::divide:
    case Code::min:
    case Code::max:
      return 2;
    default:
      return 1;
  }
}

template <typename Number, typename Column>
Number Expression::run(Column column) const {
  std::array<Number, kDeepest + 1> stack{};
  std::size_t top = 0;
  for (const Step& step : steps_) {
    switch (step.operands()) {
      case 0:
        stack[top++] = step.code == Code::number ? Number{step.number} : column(step.column);
        break;
      case 1:
        stack[top - 1] = applied(step, stack[top - 1]);
        break;
      default:
        --top;
        stack[top - 1] = applied(step, stack[top - 1], stack[top]);
        break;
    }
  }
  return stack[0];
}

double Expression::operator()(std::span<const double> x) const {
  return run<double>([x](std::size_t column) { return x[column]; });
}

Slope Expression::slope(std::span<const double> x, std::size_t k) const {
  return run<Slope>([x, k](std::size_t column) {
    return Slope{x[column], column == k ? 1.0 : 0.0};
  });
}

std::optional<Unit> Expression::unit(std::span<const std::optional<Unit>> columns) const {
  std::vector<Known> stack;
  const auto pop = [&] {
    Known top = std::move(stack.back());
    stack.pop_back();
    return top;
  };
  for (const Step& step : steps_) {
    switch (step.code) {
      case Code::number:
        stack.push_back({Unit{}, step.number == 0.0});
        break;
      case Code::column:
        stack.push_back({columns[step.column]});
        break;
      case Code::negate:
      case Code::abs:
        break;
      case Code::sign:
        stack.back() = {Unit{}};
        break;
      case Code::power:
        stack.back() = power(stack.back(), step.number);
        break;
      case Code::sqrt:
        stack.back() = power(stack.back(), 0.5);
        break;
      case Code::sin:
      case Code::cos:
      case Code::tanh:
        stack.back() = plain_of_plain(stack.back());
        break;
      default: {
        const Known right = pop();
        const bool scales = step.code == Code::multiply || step.code == Code::divide;
        stack.back() = scales ? product(stack.back(), right, step.code == Code::divide)
                              : common(stack.back(), right);
        break;
      }
    }
  }
  return stack.back().unit;
}

}  // namespace kelpie
