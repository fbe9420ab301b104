// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/trained_model.hpp"

namespace kelpie {

void TrainedModel::predict(std::span<const double> x, std::span<double> y) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisScaling& scaling = axes[i].scaling;
    y[i] = scaling.target.invert(axes[i].function(as_span(scale_sample(scaling, terms, x))));
  }
}

}  // namespace kelpie
