// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kelpie::chart {

// Files embedded in every page; CMake writes the source (cmake/PageAssets.cmake).
extern const std::string_view kPageStyle;       ///< page.css
extern const std::string_view kFigureScript;    ///< figure.js
extern const std::string_view kLiveScript;      ///< web/live.js, for the page of a running program
extern const std::string_view kLibraryScript;   ///< uPlot; empty in a build without uPlot
extern const std::string_view kLibraryStyle;    ///< style sheet of uPlot
extern const std::string_view kLibraryLicence;  ///< licence of uPlot

}  // namespace kelpie::chart
