// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "vehicle/comparison.hpp"

namespace kelpie {

/// One explanation or a pair, with its evidence.
struct Choice {
  std::size_t one = 0;    ///< place in the list of explanations
  std::size_t other = 0;  ///< equal to `one` for a single explanation
  Agreement agreement;
  double worth = 0.0;  ///< evidence minus the BIC penalty for the number of sizes
};

/// The explanations of a change in the order of their worth, as far as a finding needs.
struct CauseRanking {
  FindingState state = FindingState::looking;
  Choice best;
  Choice rival;             ///< the best choice with another cause
  double margin = 0.0;      ///< difference of the two worths
  double explained = 0.0;   ///< evidence of the best over that of an unrestricted refit
  double dispersion = 1.0;  ///< scatter of the rows over the scatter of independent noise
};

/// Ranks all explanations and pairs of explanations. `alone`: agreement of each explanation by
/// itself; `rows`: of the stretch; `least_dispersion`: without a change; `unknowns`: of the
/// unrestricted refit. Cost: some hundred systems of few equations. Allocates nothing.
CauseRanking rank_causes(const Comparison& comparison, std::span<const Explanation> explanations,
                         std::span<const Agreement> alone, double rows, double least_dispersion,
                         std::size_t unknowns);

}  // namespace kelpie
