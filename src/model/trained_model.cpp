// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/trained_model.hpp"

#include <algorithm>
#include <iterator>

#include "kelpie/model/axis_gradient.hpp"

namespace kelpie {

std::vector<std::string> TrainedModel::target_names() const {
  std::vector<std::string> names;
  std::ranges::transform(axes, std::back_inserter(names), &Axis::name);
  return names;
}

void TrainedModel::predict(std::span<const double> x, std::span<double> y) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisScaling& scaling = axes[i].scaling;
    y[i] = scaling.target.invert(axes[i].function(as_span(scale_sample(scaling, terms, x))));
  }
}

void TrainedModel::predict(std::span<const double> x, std::span<Prediction> y) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Axis& axis = axes[i];
    const ScaledSample sample = scale_sample(axis.scaling, terms, x);
    const double value = axis.scaling.target.invert(axis.function(as_span(sample)));
    y[i] = {.value = value, .lower = value - axis.half_width, .upper = value + axis.half_width};
    if (axis.known) {
      y[i].novelty = axis.known->novelty(as_span(sample).first(x.size()));
    }
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
