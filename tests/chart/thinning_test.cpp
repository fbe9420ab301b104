// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "chart/figure.hpp"

namespace kelpie::thinning_test {
namespace {

TEST(Thinning, KeepsTheSpikesOfALongSeriesAndItsEnds) {
  std::vector<chart::Point> points(30'000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto place = static_cast<double>(i);
    points[i] = {0.01 * place, std::sin(place)};
  }
  points[12'345].y = 50.0;
  points[20'001].y = -50.0;
  const std::vector<chart::Point> kept = chart::thinned(points);
  EXPECT_LE(kept.size(), 4U * 300U);
  const auto lower = [](const chart::Point& a, const chart::Point& b) { return a.y < b.y; };
  EXPECT_EQ(std::max_element(kept.begin(), kept.end(), lower)->y, 50.0);
  EXPECT_EQ(std::min_element(kept.begin(), kept.end(), lower)->y, -50.0);
  EXPECT_EQ(kept.front().x, points.front().x);
  EXPECT_EQ(kept.back().x, points.back().x);
  EXPECT_TRUE(
      std::is_sorted(kept.begin(), kept.end(),
                     [](const chart::Point& a, const chart::Point& b) { return a.x < b.x; }));
}

TEST(Thinning, LeavesSparsePointsAndBreaksAlone) {
  const std::vector<chart::Point> points = {{0.1, 1}, {0.2, 2}, {0.3, NAN}, {0.4, 3}, {7.0, 4}};
  const std::vector<chart::Point> kept = chart::thinned(points);
  ASSERT_EQ(kept.size(), points.size());
  EXPECT_TRUE(std::isnan(kept[2].y));
  EXPECT_TRUE(chart::thinned({}).empty());
}

}  // namespace
}  // namespace kelpie::thinning_test
