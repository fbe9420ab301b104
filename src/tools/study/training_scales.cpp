// SPDX-License-Identifier: Apache-2.0
#include "study/training_scales.hpp"

#include <cmath>
#include <optional>

#include "kelpie/core/error.hpp"
#include "kelpie/motion/term_set.hpp"

namespace kelpie::study {

std::vector<AxisScaling> training_scales(const log::Dataset& data,
                                         std::span<const std::size_t> rows,
                                         const SharedSettings& settings) {
  const ScalingKind kind = settings.scaling;
  const TermSet terms = TermSet::from(settings.terms, data.input_names, data.target_names.size());
  std::vector<double> values(terms.size());
  Moments term_moments(terms.size());
  Moments inputs(data.input_names.size());
  for (const std::size_t row : rows) {
    inputs.add(data.input(row));
    terms.evaluate(data.input(row), values);
    term_moments.add(values);
  }
  const std::optional<InputScaling> scaling = InputScaling::from(inputs, kind);
  if (!scaling) {
    const std::size_t column = first_dependent(inputs, kind).value_or(0);
    throw InputError({.file = data.source, .line = 0, .field = data.input_names[column]},
                     "is constant or a combination of the columns before it in the training rows, "
                     "so Σ is singular; leave it out of --inputs, or --set scaling=diagonal");
  }
  std::vector<double> term_scale(terms.size());
  terms.scales(inputs, term_moments, term_scale);
  std::vector<AxisScaling> scales;
  for (std::size_t axis = 0; axis < data.target_names.size(); ++axis) {
    Moments target(1);
    for (const std::size_t row : rows) {
      target.add(data.target(row).subspan(axis, 1));
    }
    scales.push_back(
        {*scaling, {target.mean()[0], std::sqrt(target.covariance(0, 0))}, term_scale});
  }
  return scales;
}

}  // namespace kelpie::study
