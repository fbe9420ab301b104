// SPDX-License-Identifier: Apache-2.0
#include "report/coverage_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "chart/wording.hpp"

namespace kelpie::report {
namespace {

constexpr std::string_view kNote =
    "Held: share of the samples inside the interval that was in force before they were learned. "
    "Lowest: in any 500 samples in a row of one configuration, from its 501st on. Widths are in "
    "the target's unit.";

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100.0 * share) : "–";
}

std::string promised(const study::StreamResult& result) {
  const auto found =
      std::ranges::find(result.settings, "coverage", &std::pair<std::string, std::string>::first);
  return found == result.settings.end() ? "" : " (promised: " + found->second + ")";
}

}  // namespace

chart::TextTable coverage_table(const study::StreamResult& result) {
  chart::TextTable table{
      "Intervals one step ahead" + promised(result),
      {"axis", "samples", "held", "lowest", "mean width", "median width", "unit"},
      {},
      {std::string(kNote)}};
  for (const study::AxisResult& axis : result.axes) {
    const std::string name = chart::shortened(axis.name, chart::kLongestName);
    for (const auto& [coverage, row] :
         {std::pair(axis.coverage, name),
          std::pair(axis.corrected_coverage, name + " with disturbance")}) {
      if (coverage.samples == 0) {
        continue;
      }
      table.rows.push_back({row, chart::grouped(static_cast<std::int64_t>(coverage.samples)),
                            percent(coverage.share), percent(coverage.lowest),
                            chart::significant(coverage.mean_width),
                            chart::significant(coverage.median_width),
                            axis.unit.empty() ? "–" : chart::printable(axis.unit)});
    }
  }
  return table;
}

}  // namespace kelpie::report
