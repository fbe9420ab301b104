// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/comparison.hpp"

namespace kelpie::format {

/// Everything as JSON (docs/compare.md), with the recommendation in words. NaN is written as null.
/// Requires a comparison that ran to its end, with kelpie as the first contest.
std::string comparison_json(const study::Comparison& comparison,
                            const std::vector<std::string>& recommendation);

}  // namespace kelpie::format
