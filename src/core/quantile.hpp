// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace kelpie {

/// The p-quantile with linear interpolation between order statistics (Hyndman and Fan's type 7,
/// the default of R and NumPy). Reorders `values`. Requires: not empty, no NaN, 0 <= p <= 1.
/// Cost O(n). Allocates nothing.
double quantile(std::span<double> values, double p);

}  // namespace kelpie
