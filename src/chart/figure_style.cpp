// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

#include "chart/figure.hpp"

namespace kelpie::chart {
namespace {

// Okabe & Ito's palette without its yellow, which is lost on white paper; black is the text's own
// colour, so that it turns white on a dark page.
constexpr std::array<std::string_view, 7> kColours = {
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "currentColor"};

constexpr std::array<std::string_view, 7> kDashes = {"none",        "8 3",  "2 2.5", "9 3 2 3",
                                                     "5 2 1 2 1 2", "12 5", "4 4"};

constexpr std::string_view kCommon = R"(
.figure { display: block; width: 100%; height: auto; color: inherit;
  font: 12px system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
.figure text { fill: currentColor; }
.figure .label, .figure .key { font-weight: 500; }
.figure .grid { stroke: currentColor; stroke-opacity: 0.16; fill: none; }
.figure .axis { stroke: currentColor; stroke-opacity: 0.7; fill: none; }
.figure .mark { stroke: currentColor; stroke-opacity: 0.75; stroke-dasharray: 4 3; fill: none; }
.figure .line { stroke-width: 1.7; stroke-linejoin: round; fill: none; }
.figure .marker { stroke-width: 1.4; fill: none; }
.figure .dot { stroke-width: 3; stroke-linecap: round; stroke-opacity: 0.5; fill: none; }
.figure .band { fill-opacity: 0.18; }
.figure .box { shape-rendering: crispEdges; }
@media (prefers-color-scheme: dark) { .figure .s0 { stroke: #3d9fdb; } }
)";

}  // namespace

std::string figure_style() {
  std::string style;
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    style += fmt::format(
        ".figure .s{0} {{ stroke: {1}; }}\n.figure .f{0} {{ fill: {1}; }}\n"
        ".figure .d{0} {{ stroke-dasharray: {2}; }}\n",
        i, kColours[i], kDashes[i]);
  }
  return style + std::string(kCommon);
}

}  // namespace kelpie::chart
