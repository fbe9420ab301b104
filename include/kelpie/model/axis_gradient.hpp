// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kelpie/core/scaling.hpp"
#include "kelpie/physics/term_set.hpp"
#include "kelpie/svr/svr_function.hpp"

namespace kelpie {

/// The prediction of one axis, y = mean + scale f(z, φ), and its gradient by the raw inputs,
///
///     ∂y/∂x = scale (Wᵀ ∂f/∂z + Σ_k w_k / scale_k ∂φ_k/∂x),
///
/// with TermSet::add_gradient's values where a term has a kink. The prediction is that of predict()
/// to rounding. Requires finite x and room for x.size() values. Cost once to twice that of a
/// prediction. Allocates nothing; safe from many threads.
double predict_with_gradient(const AxisScaling& scaling, const TermSet& terms,
                             const SvrFunction& function, std::span<const double> x,
                             std::span<double> gradient);

}  // namespace kelpie
