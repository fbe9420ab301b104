// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bag/inspect.hpp"

namespace kelpie::report {

/// What a bag holds, for a terminal: the bag, a line per topic, the ranges of the fields.
std::string inspect_table(const bag::BagReport& report, const std::string& source);

/// The same as JSON (docs/bags.md).
std::string inspect_json(const bag::BagReport& report, const std::string& source);

}  // namespace kelpie::report
