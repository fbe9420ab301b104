// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lab/reckoning.hpp"

namespace kelpie::lab {

/// A table per result, for a terminal.
std::string reckoning_table(const std::vector<ReckoningResult>& results);

/// All results as JSON (docs/dead_reckoning.md).
std::string reckoning_json(const std::vector<ReckoningResult>& results);

}  // namespace kelpie::lab
