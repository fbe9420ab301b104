// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kelpie/core/scaling.hpp"
#include "kelpie/kernel/squared_exponential.hpp"
#include "kelpie/motion/term_set.hpp"

namespace kelpie {

static_assert(kMostInputs <= SquaredExponential::kMostDimensions);

/// The gradient of an axis by its raw inputs, y = mean + scale f(z, φ), from that by its sample:
///
///     ∂y/∂x = scale (Wᵀ ∂f/∂z + Σ_k ∂f/∂φ_k / scale_k ∂φ_k/∂x),
///
/// with TermSet::add_gradient's values where a term has a kink. `by_sample` is scratch afterwards.
/// Requires finite x and room for x.size() values. Allocates nothing; safe from many threads.
void pull_back(const AxisScaling& scaling, const TermSet& terms, std::span<const double> x,
               std::span<double> by_sample, std::span<double> gradient);

/// The prediction of one axis and its gradient by the raw inputs. `function` has
/// with_gradient(sample, gradient), as SvrFunction and FunctionMix have. The prediction is that of
/// predict() to rounding. Conditions as above. Cost once to twice that of a prediction.
template <typename Function>
double predict_with_gradient(const AxisScaling& scaling, const TermSet& terms,
                             const Function& function, std::span<const double> x,
                             std::span<double> gradient) {
  const ScaledSample sample = scale_sample(scaling, terms, x);
  ScaledSample slopes(sample.size());
  const double value = function.with_gradient(as_span(sample), slopes);
  pull_back(scaling, terms, x, slopes, gradient);
  return scaling.target.invert(value);
}

}  // namespace kelpie
