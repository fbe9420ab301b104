// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "chart/figure.hpp"

namespace kelpie::chart {
namespace {

// Points of one pixel column, or one break.
std::size_t column_end(std::span<const Point> points, std::size_t first) {
  std::size_t end = first + 1;
  while (!std::isnan(points[first].y) && end < points.size() && !std::isnan(points[end].y) &&
         std::floor(points[end].x) == std::floor(points[first].x)) {
    ++end;
  }
  return end;
}

}  // namespace

std::vector<Point> thinned(std::span<const Point> points) {
  std::vector<Point> kept;
  for (std::size_t first = 0; first < points.size();) {
    const std::size_t end = column_end(points, first);
    const auto column = points.subspan(first, end - first);
    const auto [least, greatest] = std::minmax_element(
        column.begin(), column.end(), [](const Point& a, const Point& b) { return a.y < b.y; });
    std::vector<std::size_t> chosen = {0, static_cast<std::size_t>(least - column.begin()),
                                       static_cast<std::size_t>(greatest - column.begin()),
                                       column.size() - 1};
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const std::size_t index : chosen) {
      kept.push_back(column[index]);
    }
    first = end;
  }
  return kept;
}

}  // namespace kelpie::chart
