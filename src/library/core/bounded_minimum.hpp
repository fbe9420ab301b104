// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace kelpie {

/// The minimum of ½ zᵀHz − gᵀz over lower ≤ z ≤ upper, by a primal active set (Nocedal & Wright,
/// Numerical Optimization, 2006, algorithm 16.3, with bounds for constraints; for the allocation of
/// thrust Härkegård 2002). Requires a positive definite H of n² numbers, lower ≤ upper, all finite,
/// and room for n numbers in `z`, which satisfies the KKT conditions to rounding. Allocates. Cost:
/// O(n³) per change of the active set.
void bounded_minimum(std::span<const double> h, std::span<const double> g,
                     std::span<const double> lower, std::span<const double> upper,
                     std::span<double> z);

}  // namespace kelpie
