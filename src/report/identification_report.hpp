// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/identification.hpp"

namespace kelpie::report {

/// For a terminal: parameters with intervals, R² on held-out rows, and what to mind.
std::string identification_table(const study::Identification& found);

/// One page: what to mind, accelerations measured and as the identified vehicle has them, the
/// parameters and their correlations.
std::string identification_html(const study::Identification& found);

/// What to mind: the scale, what isn't told, where the structure doesn't fit. Sentences.
std::vector<std::string> identification_remarks(const study::Identification& found);

}  // namespace kelpie::report
