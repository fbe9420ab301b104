// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// How well each axis' intervals kept what they promise, with a note on what the columns mean; no
/// rows where no axis has intervals.
chart::TextTable coverage_table(const study::StreamResult& result);

inline constexpr std::string_view kNoveltyNote =
    "Novelty: the share of the buffer's samples that lie in a denser place; 0: well-known ground, "
    "1: where nothing is known. Bins without rows are left empty.";

}  // namespace kelpie::report
