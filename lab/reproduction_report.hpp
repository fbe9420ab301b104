// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// The self-contained page: HTML without network access, well-formed XML.
std::string reproduction_html(const Reproduction& result);

/// The numbers as JSON (measured/reproduction.md). The same plan gives the same bytes, except for
/// "update_us". NaN is written as null.
std::string reproduction_json(const Reproduction& result);

/// For a terminal: R² at the end of each configuration beside the baseline's, the published
/// protocol, and the number of verified claims.
std::string reproduction_table(const Reproduction& result);

}  // namespace kelpie::lab
