// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lab/reproduction.hpp"
#include "report/stream_figures.hpp"

namespace kelpie::lab {

constexpr chart::PlotSize kPanel{400, 250};  ///< one of several in a row
constexpr chart::PlotSize kWide{980, 300};   ///< one that has the page's width

/// R² of some contenders on one axis over the stream: mean of the seeds as a line, least to
/// greatest as a band; the off-line baseline's level as steps, where there is one. The R² axis
/// never goes below −0.2: what lies lower is drawn on the edge, and the caption says so.
chart::Panel comparison_panel(const StreamStudy& study, const std::vector<std::string>& keys,
                              std::size_t axis, chart::PlotSize size);

/// The first seed's held-out rows at the end of a stage, true and predicted, over time.
chart::Panel prediction_panel(const StreamStudy& study, std::string_view key, std::size_t axis,
                              std::size_t stage, chart::PlotSize size);

/// R² on the published test rows over the steps.
chart::Panel published_panel(const std::vector<PublishedRun>& runs, chart::PlotSize size);

}  // namespace kelpie::lab
