// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "chart/figure.hpp"
#include "report/stream_figures.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// The end of the stream: each sample as it was and as it was predicted just before it was learned,
/// with the interval then in force.
chart::Panel interval_panel(const study::AxisResult& axis, chart::PlotSize size);

/// Share of samples inside their interval, over windows of kCoverageWindow samples, of all axes
/// over the samples shown.
chart::Panel coverage_panel(const study::StreamResult& result, chart::PlotSize size);

/// Error on held-out rows by the novelty of their place.
chart::Panel novelty_panel(const study::AxisResult& axis, chart::PlotSize size);

}  // namespace kelpie::report
