// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kelpie/svr/regressor.hpp"
#include "log/dataset.hpp"
#include "study/result.hpp"

namespace kelpie::study {

/// One physics term over the stream. Its effect is coefficient × rms of the term, in the target's
/// unit, so that effects of terms compare. NaN: no model in service.
struct TermView {
  TermInfo term;
  double value = 0.0;          ///< coefficient at the end of the stream
  double at_half = 0.0;        ///< coefficient at the last look in the first half
  double effect = 0.0;         ///< at the end
  std::vector<double> values;  ///< coefficients at each look
  std::vector<double> errors;  ///< standard errors at each look; NaN also where unknown
};

/// In the order of the terms.
std::vector<TermView> term_views(const AxisResult& axis);

/// The `most` terms with the largest effects over the stream (mean of |effect|), order kept.
std::vector<TermView> most_effective(const std::vector<TermView>& views, std::size_t most);

/// The unit of a column of the log as text; empty: unknown.
std::string unit_text(const log::Dataset& data, const std::string& column);

/// The unit of a term's coefficient in the model of `target`, as text; empty where the unit of a
/// column is unknown. Requires a formula over the log's inputs.
std::string coefficient_unit(const std::string& term, const log::Dataset& data,
                             const std::string& target);

/// Units, scales and errors of a learner's terms, from the rows shown to the learner. Requires
/// terms that are formulas over the log's inputs, and at least one row.
std::vector<TermInfo> describe_terms(const std::vector<Coefficient>& coefficients,
                                     const log::Dataset& data, const std::string& target,
                                     std::span<const std::size_t> rows);

}  // namespace kelpie::study
