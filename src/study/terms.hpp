// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kelpie/online/regressor.hpp"
#include "log/dataset.hpp"
#include "study/result.hpp"

namespace kelpie::study {

/// What a learner believed of one physics term. The effect is what the term adds to the prediction
/// at its own root mean square: coefficient × rms, in the target's unit, so that terms compare.
struct TermView {
  TermInfo term;
  double value = 0.0;    ///< coefficient at the end of the stream, NaN where there is none
  double at_half = 0.0;  ///< at the last look in the first half, NaN where there was none
  double effect = 0.0;   ///< of the coefficient at the end
  // At each look; NaN where no model was in service, or the error isn't known.
  std::vector<double> values;  ///< coefficients
  std::vector<double> errors;  ///< their standard errors
};

/// In the order of the terms.
std::vector<TermView> term_views(const AxisResult& axis);

/// The `most` of them whose effects were largest over the stream (mean of |effect|), in their
/// order.
std::vector<TermView> most_effective(const std::vector<TermView>& views, std::size_t most);

/// The unit of a column of the log as text; empty where none is given.
std::string unit_text(const log::Dataset& data, const std::string& column);

/// The unit of a term's coefficient in the model of `target`, as text; empty where units of columns
/// that it takes aren't given. Requires a formula over the log's inputs.
std::string coefficient_unit(const std::string& term, const log::Dataset& data,
                             const std::string& target);

/// What is known of a learner's terms besides their coefficients, from the rows it was shown.
/// Requires coefficients whose terms are formulas over the log's inputs, and at least one row.
std::vector<TermInfo> describe_terms(const std::vector<Coefficient>& coefficients,
                                     const log::Dataset& data, const std::string& target,
                                     std::span<const std::size_t> rows);

}  // namespace kelpie::study
