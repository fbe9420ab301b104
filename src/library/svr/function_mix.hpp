// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "svr/svr_function.hpp"

namespace kelpie {

/// Limits of predictions, in units of the standardised target.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// A function and its weight in a weighted mean.
struct WeightedFunction {
  double share = 1.0;
  const SvrFunction* function = nullptr;
};

/// The weighted mean of functions, each clamped to the limits: Σ share_k · clamp(f_k(x), low,
/// high), on scaled samples. Requires shares with the sum 1. Cost: the sum over the functions.
/// Allocates nothing; safe from many threads.
double mixed_value(std::span<const WeightedFunction> functions, const Limits& limits,
                   std::span<const double> x);

/// mixed_value(), equal to rounding, and its gradient by z and φ; beyond the limits a function has
/// the slope 0. Requires finite x and room for x.size() <= kMostInputs + kMostTerms values.
double mixed_value_with_gradient(std::span<const WeightedFunction> functions, const Limits& limits,
                                 std::span<const double> x, std::span<double> gradient);

/// A weighted mean of functions, with copies of the functions.
struct FunctionMix {
  /// A function with name and weight.
  struct Member {
    std::string name;  ///< of a committee's member
    double share = 1.0;
    SvrFunction function;
  };

  std::vector<Member> members;
  Limits limits{};

  double operator()(std::span<const double> x) const;  ///< mixed_value()
  /// mixed_value_with_gradient()
  double with_gradient(std::span<const double> x, std::span<double> gradient) const;

  /// The weight of a physics term inside the limits: Σ share_k w_k.
  double term_weight(std::size_t k) const;
};

}  // namespace kelpie
