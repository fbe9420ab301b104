// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/comparison.hpp"

namespace kelpie::format {

/// A comparison as JSON (howto/studies.md), with the recommendation in words; NaN becomes null.
/// Requires a finished comparison with kelpie as the first contest.
std::string comparison_json(const study::Comparison& comparison,
                            const std::vector<std::string>& recommendation);

}  // namespace kelpie::format
