// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// How well each axis' intervals kept what they promise; no rows where no axis has intervals.
chart::TextTable coverage_table(const study::StreamResult& result);

/// What its columns mean, in a sentence or two.
inline constexpr std::string_view kCoverageNote =
    "Held: share of the samples inside the interval that was in force before they were learned. "
    "Lowest: in any 500 samples in a row of one configuration, from its 501st on. Widths are in "
    "the target's unit.";

inline constexpr std::string_view kNoveltyNote =
    "Novelty: the share of the buffer's samples that lie in a denser place; 0: well-known ground, "
    "1: where nothing is known. Bins without rows are left empty.";

}  // namespace kelpie::report
