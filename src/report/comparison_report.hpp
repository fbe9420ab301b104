// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/comparison.hpp"

namespace kelpie::report {

// All require a comparison that ran to its end, with kelpie as the first contest.

/// For a terminal: the split, the rows, R² of all contenders axis by axis, and the recommendation.
std::string comparison_table(const study::Comparison& comparison);

/// One page: the recommendation, figures and tables.
std::string comparison_html(const study::Comparison& comparison);

}  // namespace kelpie::report
