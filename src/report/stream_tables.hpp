// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

// Tables of one stream, for a terminal and for a page, with notes on what their columns mean. No
// rows where no axis has anything to say.

/// What the simple predictors are.
inline constexpr std::string_view kBaselineNote =
    "Least squares: recursive, on physics terms (x and x|x| of every input, products and "
    "squares of velocities), robust, nothing forgotten. Mean: of the targets so far. Last value: "
    "the target "
    "one sample ago; one step ahead it is hard to beat, and it says nothing of what comes later.";

/// R² of the learned model beside that of simple predictors, with a note on what they are.
chart::TextTable baseline_table(const study::StreamResult& result);

/// How much each member of an axis' committee is believed at the end, with a note on what they are.
/// No rows where every axis has one learner.
chart::TextTable member_table(const study::StreamResult& result);

/// How well each axis' intervals kept what they promise, with a note on what the columns mean; no
/// rows where no axis has intervals.
chart::TextTable coverage_table(const study::StreamResult& result);

inline constexpr std::string_view kNoveltyNote =
    "Novelty: the share of the buffer's samples that lie in a denser place; 0: well-known ground, "
    "1: where nothing is known. Bins without rows are left empty.";

/// One table per axis that has coefficients: term, coefficient, its unit, what it was at half of
/// the stream and by how much it changed since, and its effect. A note on their columns is with the
/// last.
std::vector<chart::TextTable> coefficient_tables(const study::StreamResult& result);

}  // namespace kelpie::report
