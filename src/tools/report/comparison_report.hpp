// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "chart/text_table.hpp"
#include "study/comparison.hpp"

namespace kelpie::report {

/// A measure of the comparison.
struct ComparedR2 {
  std::string_view title;
  double study::AxisResult::*value = nullptr;
};

inline constexpr ComparedR2 kHeldOutR2{"R² on held-out rows, at the end",
                                       &study::AxisResult::r2_final};
inline constexpr ComparedR2 kMeanR2{"R² on held-out rows, mean over the stream",
                                    &study::AxisResult::r2_mean};
inline constexpr ComparedR2 kOneStepR2{"R² one step ahead", &study::AxisResult::prequential_r2};

/// A row per axis, a column per contender with this measure.
chart::TextTable comparison_view(const study::Comparison& comparison, const ComparedR2& r2);

/// The contenders and the rows of their scores, in sentences.
std::string contenders_note(const study::Comparison& comparison);

/// comparison_view() as a figure: a place per axis, a marker per contender. Shows the range of
/// learners and least squares, not below −0.2.
std::string comparison_figure(const study::Comparison& comparison, const ComparedR2& r2);

/// Validation R² of the contenders over the stream, of an axis.
std::string contenders_figure(const study::Comparison& comparison, std::size_t axis);

// All require a finished comparison with kelpie as the first contest.

/// A row per contender with R² on held-out rows, the best mean of the axes first.
chart::TextTable ranked_view(const study::Comparison& comparison);

/// For a terminal: the split, the rows, R² of the contenders by axis, and the recommendation.
std::string comparison_table(const study::Comparison& comparison);

/// One page: the verdict, the ranking, figures, and the recommendation axis by axis.
std::string comparison_html(const study::Comparison& comparison);

}  // namespace kelpie::report
