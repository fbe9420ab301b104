// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/axis_gradient.hpp"

namespace kelpie {

static_assert(kMostInputs <= SquaredExponential::kMostDimensions);

double predict_with_gradient(const AxisScaling& scaling, const TermSet& terms,
                             const SvrFunction& function, std::span<const double> x,
                             std::span<double> gradient) {
  const ScaledSample sample = scale_sample(scaling, terms, x);
  ScaledSample slopes(sample.size());
  const std::span<double> by_sample(slopes.data(), static_cast<std::size_t>(slopes.size()));
  const double value = function.with_gradient(as_span(sample), by_sample);

  const auto inputs = static_cast<Eigen::Index>(x.size());
  Eigen::Map<Eigen::VectorXd> by_x(gradient.data(), inputs);
  by_x = scaling.input.pull_back(by_sample.first(x.size()));
  const std::span<double> weights = by_sample.subspan(x.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] /= scaling.term_scale[k];
  }
  terms.add_gradient(x, weights, gradient);
  by_x *= scaling.target.scale;
  return scaling.target.invert(value);
}

}  // namespace kelpie
