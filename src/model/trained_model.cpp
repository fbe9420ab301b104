// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/trained_model.hpp"

#include <algorithm>
#include <iterator>

#include "kelpie/model/axis_gradient.hpp"
#include "model/answer.hpp"

namespace kelpie {

std::vector<std::string> TrainedModel::target_names() const {
  std::vector<std::string> names;
  std::ranges::transform(axes, std::back_inserter(names), &Axis::name);
  return names;
}

void TrainedModel::predict(std::span<const double> x, std::span<double> y) const {
  answer(x, input_names.size(), y, axes.size(), [&](std::size_t i) {
    const AxisScaling& scaling = axes[i].scaling;
    return scaling.target.invert(axes[i].function(as_span(scale_sample(scaling, terms, x))));
  });
}

void TrainedModel::predict(std::span<const double> x, std::span<Prediction> y) const {
  answer(x, input_names.size(), y, axes.size(), [&](std::size_t i) {
    const Axis& axis = axes[i];
    const ScaledSample sample = scale_sample(axis.scaling, terms, x);
    const double value = axis.scaling.target.invert(axis.function(as_span(sample)));
    Prediction prediction{
        .value = value, .lower = value - axis.half_width, .upper = value + axis.half_width};
    if (axis.known) {
      prediction.novelty = axis.known->novelty(as_span(sample).first(x.size()));
    }
    return prediction;
  });
}

void TrainedModel::predict_with_jacobian(std::span<const double> x, std::span<double> y,
                                         std::span<double> jacobian) const {
  answer(x, input_names.size(), y, axes.size(), jacobian,
         [&](std::size_t i, std::span<double> gradient) {
           return predict_with_gradient(axes[i].scaling, terms, axes[i].function, x, gradient);
         });
}

}  // namespace kelpie
