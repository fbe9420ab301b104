// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kelpie::chart {

// Files that go into every page; CMake makes the source (cmake/PageAssets.cmake).
extern const std::string_view kPageStyle;       ///< page.css
extern const std::string_view kFigureScript;    ///< figure.js
extern const std::string_view kLiveScript;      ///< web/live.js, for the page of a running program
extern const std::string_view kLibraryScript;   ///< uPlot; empty where kelpie was built without it
extern const std::string_view kLibraryStyle;    ///< … its style sheet
extern const std::string_view kLibraryLicence;  ///< … its licence

}  // namespace kelpie::chart
