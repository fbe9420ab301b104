// SPDX-License-Identifier: Apache-2.0
#include "coverage_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kelpie/report/wording.hpp"

namespace kelpie {
namespace {

constexpr std::size_t kLongestName = 24;

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100.0 * share) : "–";
}

std::string promised(const StreamResult& result) {
  const auto found =
      std::ranges::find(result.settings, "coverage", &std::pair<std::string, std::string>::first);
  return found == result.settings.end() ? "" : " (promised: " + found->second + ")";
}

}  // namespace

TextTable coverage_table(const StreamResult& result) {
  TextTable table{"Intervals one step ahead" + promised(result),
                  {"axis", "samples", "held", "lowest", "mean width", "median width", "unit"},
                  {}};
  for (const AxisResult& axis : result.axes) {
    if (const Coverage& coverage = axis.coverage; coverage.samples > 0) {
      table.rows.push_back(
          {shortened(axis.name, kLongestName), grouped(static_cast<std::int64_t>(coverage.samples)),
           percent(coverage.share), percent(coverage.lowest), significant(coverage.mean_width),
           significant(coverage.median_width), axis.unit.empty() ? "–" : printable(axis.unit)});
    }
  }
  return table;
}

}  // namespace kelpie
