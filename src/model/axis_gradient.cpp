// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/axis_gradient.hpp"

#include <algorithm>

#include "core/eigen.hpp"

namespace kelpie {

void pull_back(const AxisScaling& scaling, const TermSet& terms, std::span<const double> x,
               std::span<double> by_sample, std::span<double> gradient) {
  const std::span<double> by_x = gradient.first(x.size());
  std::ranges::copy(scaling.input.pull_back(by_sample.first(x.size())), by_x.begin());
  const std::span<double> weights = by_sample.subspan(x.size());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] /= scaling.term_scale[k];
  }
  terms.add_gradient(x, weights, gradient);
  as_vector(by_x) *= scaling.target.scale;
}

}  // namespace kelpie
