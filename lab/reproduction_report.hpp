// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// Everything as one HTML file that needs nothing else: no network, no script; well-formed XML.
std::string reproduction_html(const Reproduction& result);

/// All numbers as JSON (docs/reproduction.md). The same plan gives the same bytes, but for what
/// stands under "update_us". NaN is written as null.
std::string reproduction_json(const Reproduction& result);

/// For a terminal: R² at the end of each configuration beside the baseline's, the published
/// protocol, and how many claims hold.
std::string reproduction_table(const Reproduction& result);

}  // namespace kelpie::lab
