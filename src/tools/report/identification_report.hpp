// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/identification.hpp"

namespace kelpie::report {

/// For a terminal: parameters with intervals, R² on held-out rows, and warnings.
std::string identification_table(const study::Identification& found);

/// One page: warnings, accelerations measured and of the identified vehicle, parameters and
/// correlations.
std::string identification_html(const study::Identification& found);

/// Warnings as sentences: the scale, unidentified parameters, axes with a poor fit.
std::vector<std::string> identification_remarks(const study::Identification& found);

}  // namespace kelpie::report
