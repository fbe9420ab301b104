// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "kelpie/svr/svr_function.hpp"

namespace kelpie {

/// Bounds of what is ever said, in units of the standardised target.
struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// One of several functions that say something together.
struct Voice {
  double share = 1.0;  ///< how much it is believed
  const SvrFunction* function = nullptr;
};

/// What several functions say together: Σ share_k · clamp(f_k(x), low, high), on scaled samples.
/// Requires shares that add up to 1. Cost that of all functions. Allocates nothing; safe from many
/// threads.
double consensus(std::span<const Voice> voices, const Bounds& bounds, std::span<const double> x);

/// The same, to rounding, and its gradient by z and φ; a function beyond its bounds has a slope of
/// 0. Requires finite x and room for x.size() <= kMostInputs + kMostTerms values.
double consensus_with_gradient(std::span<const Voice> voices, const Bounds& bounds,
                               std::span<const double> x, std::span<double> gradient);

/// Functions that say something together, with copies of their own.
struct Consensus {
  /// One of them.
  struct Member {
    std::string name;  ///< as MemberNote has it
    double share = 1.0;
    SvrFunction function;
  };

  std::vector<Member> members;
  Bounds bounds{};

  double operator()(std::span<const double> x) const;  ///< consensus()
  /// consensus_with_gradient()
  double with_gradient(std::span<const double> x, std::span<double> gradient) const;

  /// What all members say of a physics term, inside their bounds: Σ share_k w_k.
  double term_weight(std::size_t k) const;
};

}  // namespace kelpie
