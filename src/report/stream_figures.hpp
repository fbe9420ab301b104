// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "chart/figure.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// One line of r2_panel().
struct R2Line {
  std::string name;
  const study::AxisResult* axis = nullptr;
};

/// Validation R² over the samples shown, in the order of the lines. The axis never goes below −0.2:
/// what lies lower is drawn on the edge and counted in the caption. Changes of the vehicle are
/// marked, those in the log and those found.
chart::Panel r2_panel(const std::vector<R2Line>& lines, chart::PlotSize size);
chart::Panel r2_panel(const study::StreamResult& result, chart::PlotSize size);  ///< Of all axes.

/// A stretch of held-out rows, true and predicted, over time.
chart::Panel stretch_panel(const study::StreamResult& result, const study::AxisResult& axis,
                           chart::PlotSize size);

/// Predicted against true, all held-out rows (thinned).
chart::Panel scatter_panel(const study::AxisResult& axis, chart::PlotSize size);

/// Buffer and support vectors over the samples shown.
chart::Panel buffer_panel(const study::AxisResult& axis, chart::PlotSize size);

/// Shares of the samples between validation points that each rule decided.
chart::Panel shares_panel(const study::AxisResult& axis, chart::PlotSize size);

/// Outliers, forgotten and released samples between validation points.
chart::Panel departures_panel(const study::AxisResult& axis, chart::PlotSize size);

/// Effects of the physics terms over the samples shown (terms.hpp): the seven largest.
chart::Panel coefficients_panel(const study::AxisResult& axis, chart::PlotSize size);

/// Histogram of the update times, logarithmic, median and p99 marked.
chart::Panel timing_panel(const study::AxisResult& axis, chart::PlotSize size);

}  // namespace kelpie::report
