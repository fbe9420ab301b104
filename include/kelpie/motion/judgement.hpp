// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kelpie/motion/comparison.hpp"

namespace kelpie {

/// An explanation, or two, with what they are worth.
struct Choice {
  std::size_t one = 0;    ///< place in the list of explanations
  std::size_t other = 0;  ///< the same as `one`: alone
  Agreement agreement;    ///< with the rows
  double worth = 0.0;     ///< evidence less what so many sizes explain of nothing (BIC)
};

/// What rows after a change say of it.
struct Judgement {
  FindingState state = FindingState::looking;  ///< what can be said
  Choice best;                                 ///< worth most
  Choice rival;                                ///< worth most of those that are another cause
  double margin = 0.0;                         ///< between the two
  double explained = 0.0;                      ///< share of `whole` that the best explains
  double dispersion = 1.0;  ///< how many times more rows scatter than independent noise would
};

/// Compares all explanations, and pairs of them, by what they are worth. `alone`: how each agrees
/// by itself; `rows`: of the stretch; `least_dispersion`: seen without a change; `unknowns`: of the
/// refit without restriction. Cost: some hundred systems of few equations. Allocates nothing.
Judgement judge_change(const Comparison& comparison, std::span<const Explanation> explanations,
                       std::span<const Agreement> alone, double rows, double least_dispersion,
                       std::size_t unknowns);

}  // namespace kelpie
