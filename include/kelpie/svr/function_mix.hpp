// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "kelpie/svr/svr_function.hpp"

namespace kelpie {

/// Bounds of what is ever said, in units of the standardised target.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// One of several functions that say something together.
struct WeightedFunction {
  double share = 1.0;  ///< how much it is believed
  const SvrFunction* function = nullptr;
};

/// What several functions say together: Σ share_k · clamp(f_k(x), low, high), on scaled samples.
/// Requires shares that add up to 1. Cost that of all functions. Allocates nothing; safe from many
/// threads.
double mixed_value(std::span<const WeightedFunction> functions, const Limits& limits,
                   std::span<const double> x);

/// The same, to rounding, and its gradient by z and φ; a function beyond its limits has a slope of
/// 0. Requires finite x and room for x.size() <= kMostInputs + kMostTerms values.
double mixed_value_with_gradient(std::span<const WeightedFunction> functions, const Limits& limits,
                                 std::span<const double> x, std::span<double> gradient);

/// Functions that say something together, with copies of their own.
struct FunctionMix {
  /// One of them.
  struct Member {
    std::string name;  ///< as MemberNote has it
    double share = 1.0;
    SvrFunction function;
  };

  std::vector<Member> members;
  Limits limits{};

  double operator()(std::span<const double> x) const;  ///< mixed_value()
  /// mixed_value_with_gradient()
  double with_gradient(std::span<const double> x, std::span<double> gradient) const;

  /// What all members say of a physics term, inside their limits: Σ share_k w_k.
  double term_weight(std::size_t k) const;
};

}  // namespace kelpie
