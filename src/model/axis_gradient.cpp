// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/axis_gradient.hpp"

namespace kelpie {

void pull_back(const AxisScaling& scaling, const TermSet& terms, std::span<const double> x,
               std::span<double> by_sample, std::span<double> gradient) {
  const auto inputs = static_cast<Eigen::Index>(x.size());
  Eigen::Map<Eigen::VectorXd> by_x(gradient.data(), inputs);
  by_x = scaling.input.pull_back(by_sample.first(x.size()));
  const std::span<double> weights = by_sample.subspan(x.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] /= scaling.term_scale[k];
  }
  terms.add_gradient(x, weights, gradient);
  by_x *= scaling.target.scale;
}

}  // namespace kelpie
