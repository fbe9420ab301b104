// SPDX-License-Identifier: Apache-2.0
#include "model/snapshot.hpp"

#include <algorithm>

#include "core/eigen.hpp"

namespace kelpie {

Prediction IntervalState::prediction(double value, double novelty, double ahead_s) const {
  Prediction prediction{
      .value = value, .lower = value - half_width, .upper = value + half_width, .novelty = novelty};
  if (disturbance != nullptr) {
    prediction.disturbance = disturbance->ahead(value, ahead_s);
    if (disturbance->is_next(ahead_s)) {
      const double corrected = value + prediction.disturbance;
      prediction.corrected_lower = corrected - corrected_half_width;
      prediction.corrected_upper = corrected + corrected_half_width;
    }
  }
  return prediction;
}

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

double Snapshot::predict(const TermSet& terms, std::span<const double> x) const {
  return ServedAxis<FunctionMix>{scaling, terms, function}.predict(x);
}

Prediction Snapshot::assess(const TermSet& terms, std::span<const double> x, double ahead_s) const {
  const IntervalState intervals{.half_width = half_width,
                                .corrected_half_width = corrected_half_width,
                                .disturbance = disturbance ? &*disturbance : nullptr};
  const auto novelty = [&](std::span<const double> z) {
    return known ? known->novelty(z) : std::numeric_limits<double>::quiet_NaN();
  };
  return ServedAxis<FunctionMix>{scaling, terms, function}.assess(x, intervals, novelty, ahead_s);
}

double Snapshot::predict_with_gradient(const TermSet& terms, std::span<const double> x,
                                       std::span<double> gradient) const {
  return ServedAxis<FunctionMix>{scaling, terms, function}.predict_with_gradient(x, gradient);
}

}  // namespace kelpie
