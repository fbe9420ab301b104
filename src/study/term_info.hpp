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
