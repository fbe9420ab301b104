// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "kelpie/motion/expression.hpp"

namespace kelpie {
namespace {

// What is known of a value: its unit, if any, or that it is 0 and so of every unit.
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
