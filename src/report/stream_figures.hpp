// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/views.hpp"
#include "study/result.hpp"

namespace kelpie::report {

// Figures of one stream, as HTML. All over time are linked: one window, one cursor.

/// The whole run of an axis: each sample as it was and as it was predicted just before it was
/// learned, with the interval then in force; changes and outliers.
std::string course_figure(const study::AxisResult& axis, Clock clock);

/// One line of r2_figure().
struct R2Line {
  std::string name;
  const study::AxisResult* axis = nullptr;
};

/// Validation R² over time, in the order of the lines. The figure ends at −0.2: how many points lie
/// below is in the caption. Changes of the vehicle are marked, those in the log and those found.
std::string r2_figure(const std::vector<R2Line>& lines, Clock clock);
std::string r2_figure(const study::StreamResult& result, Clock clock);  ///< Of all axes.

/// All held-out rows, true and predicted by the model at the end of the stream, over time.
std::string held_out_figure(const study::AxisResult& axis, Clock clock);

/// Predicted against true, all held-out rows (thinned).
std::string scatter_figure(const study::AxisResult& axis);

/// Share of samples inside their interval, over windows of kCoverageWindow samples, of all axes.
std::string coverage_figure(const study::StreamResult& result, Clock clock);

/// Error on held-out rows by the novelty of their place.
std::string novelty_figure(const study::AxisResult& axis);

/// Buffer and support vectors over time.
std::string buffer_figure(const study::AxisResult& axis, Clock clock);

/// Shares of the samples between validation points that each rule decided.
std::string shares_figure(const study::AxisResult& axis, Clock clock);

/// Outliers, forgotten and released samples between validation points.
std::string departures_figure(const study::AxisResult& axis, Clock clock);

/// Effects of the physics terms (study/terms.hpp) with standard errors: the seven largest, in the
/// target's unit; then the coefficient of each in its own unit.
std::string effects_figure(const study::AxisResult& axis, Clock clock);
std::vector<std::string> coefficient_figures(const study::AxisResult& axis, Clock clock);

/// Histogram of the update times, logarithmic, median and p99 marked.
std::string timing_figure(const study::AxisResult& axis);

}  // namespace kelpie::report
