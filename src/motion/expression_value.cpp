// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "kelpie/motion/expression.hpp"

namespace kelpie {
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

}  // namespace kelpie
