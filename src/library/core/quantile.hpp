// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace kelpie {

/// The p-quantile with linear interpolation between order statistics (Hyndman and Fan's type 7,
/// the default of R and NumPy). Reorders `values`. Requires: not empty, no NaN, 0 <= p <= 1.
/// Cost O(n). Allocates nothing.
double quantile(std::span<double> values, double p);

/// The bound below which a further value lies with the probability `coverage`, if values come in
/// any order: the ⌈coverage · (n + 1)⌉-th smallest, and the largest where there are too few values
/// (conformal prediction: Vovk, Gammerman & Shafer 2005). Reorders `values`. Requires: not empty,
/// no NaN, 0 < coverage < 1. Allocates nothing.
double conformal_bound(std::span<double> values, double coverage);

/// Half of the 90 % interval of a Gaussian variable over the standard deviation.
inline constexpr double kNormal90 = 1.6448536269514722;

/// Standard deviation of a Gaussian variable over the median of its magnitude.
inline constexpr double kSigmaPerMedian = 1.4826;

/// Standard deviation of Gaussian errors with these magnitudes, from their median, so that outliers
/// don't matter. Reorders `magnitudes`. Requires: not empty, no NaN. Allocates nothing.
double robust_deviation(std::span<double> magnitudes);

}  // namespace kelpie
