// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/trained_model.hpp"

#include "kelpie/model/axis_gradient.hpp"

namespace kelpie {

void TrainedModel::predict(std::span<const double> x, std::span<double> y) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisScaling& scaling = axes[i].scaling;
    y[i] = scaling.target.invert(axes[i].function(as_span(scale_sample(scaling, terms, x))));
  }
}

void TrainedModel::predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                         std::span<double> jacobian) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    y[i] = predict_with_gradient(axes[i].scaling, terms, axes[i].function, x,
                                 jacobian.subspan(i * x.size(), x.size()));
  }
}

}  // namespace kelpie
