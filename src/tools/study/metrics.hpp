// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace kelpie::study {

/// The paper's goodness of fit R² = 1 − Σ(ŷ − y)² / Σ(ȳ − y)². NaN with fewer than two
/// values, or with equal values of `truth`. Requires equal sizes.
double r_squared(std::span<const double> truth, std::span<const double> predicted);

}  // namespace kelpie::study
