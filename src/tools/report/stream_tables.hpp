// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

// Tables of a stream, for a terminal and for a page, with notes on the columns. A table without
// content has no rows.

/// Definitions of the simple predictors.
inline constexpr std::string_view kBaselineNote =
    "Least squares: recursive, on physics terms (x and x|x| of every input, products and "
    "squares of velocities), robust, nothing forgotten. Mean: of the targets so far. Last value: "
    "the target one sample ago; one step ahead it is hard to beat, and it says nothing of what "
    "comes later.";

/// R² of the learned model beside R² of simple predictors.
chart::TextTable baseline_table(const study::StreamResult& result);

/// The final weights of the members of each axis. No rows where every axis has a single
/// learner.
chart::TextTable member_table(const study::StreamResult& result);

/// The actuators of the commands; no rows without any.
chart::TextTable actuator_table(const AlignmentResult& found);

/// The coverage of the intervals of each axis; no rows without intervals.
chart::TextTable coverage_table(const study::StreamResult& result);

inline constexpr std::string_view kNoveltyNote =
    "Novelty: the share of the buffer's samples that lie in a denser place; 0: well-known ground, "
    "1: where nothing is known. Bins without rows are left empty.";

/// A table per axis with coefficients: term, coefficient, unit, value at half of the stream, change
/// since, and effect. The last table has a note on the columns.
std::vector<chart::TextTable> coefficient_tables(const study::StreamResult& result);

}  // namespace kelpie::report
