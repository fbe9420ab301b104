// SPDX-License-Identifier: Apache-2.0
#include "svr/function_mix.hpp"

#include <algorithm>
#include <array>

#include "core/vector.hpp"
#include "kelpie/core/scaling.hpp"

namespace kelpie {
namespace {

// Calls `add(share, function)` for every member, whoever owns it.
template <typename Add>
void for_each(std::span<const WeightedFunction> functions, Add add) {
  for (const WeightedFunction& weighted : functions) {
    add(weighted.share, *weighted.function);
  }
}

template <typename Add>
void for_each(const std::vector<FunctionMix::Member>& members, Add add) {
  for (const FunctionMix::Member& member : members) {
    add(member.share, member.function);
  }
}

template <typename WeightedFunctions>
double value_of(const WeightedFunctions& functions, const Limits& limits,
                std::span<const double> x) {
  double sum = 0.0;
  for_each(functions, [&](double share, const SvrFunction& function) {
    sum += share * std::clamp(function(x), limits.low, limits.high);
  });
  return sum;
}

template <typename WeightedFunctions>
double value_and_gradient(const WeightedFunctions& functions, const Limits& limits,
                          std::span<const double> x, std::span<double> gradient) {
  std::array<double, kMostInputs + kMostTerms> slopes{};
  const std::span<double> own = std::span(slopes).first(x.size());
  std::ranges::fill(gradient, 0.0);
  double sum = 0.0;
  for_each(functions, [&](double share, const SvrFunction& function) {
    const double said = function.with_gradient(x, own);
    sum += share * std::clamp(said, limits.low, limits.high);
    if (said > limits.low && said < limits.high) {
      add_scaled(share, std::span<const double>(own), gradient);
    }
  });
  return sum;
}

}  // namespace

double mixed_value(std::span<const WeightedFunction> functions, const Limits& limits,
                   std::span<const double> x) {
  return value_of(functions, limits, x);
}

double mixed_value_with_gradient(std::span<const WeightedFunction> functions, const Limits& limits,
                                 std::span<const double> x, std::span<double> gradient) {
  return value_and_gradient(functions, limits, x, gradient);
}

double FunctionMix::operator()(std::span<const double> x) const {
  return value_of(members, limits, x);
}

double FunctionMix::with_gradient(std::span<const double> x, std::span<double> gradient) const {
  return value_and_gradient(members, limits, x, gradient);
}

double FunctionMix::term_weight(std::size_t k) const {
  double sum = 0.0;
  for (const Member& member : members) {
    sum += member.share * member.function.term_weights()[k];
  }
  return sum;
}

}  // namespace kelpie
