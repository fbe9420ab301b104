// SPDX-License-Identifier: Apache-2.0
#include "health/episode.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kelpie::episode_test {
namespace {

TEST(FindDives, CutsAtTheSurface) {
  std::vector<double> depths;
  for (int i = 0; i < 300; ++i) {
    depths.push_back(50.0 - 50.0 * std::cos(0.02 * std::numbers::pi * i));
  }
  const auto dives = health::find_dives(depths);
  ASSERT_EQ(dives.size(), 3U);
  EXPECT_EQ(dives[0].first, 0U);
  EXPECT_EQ(dives[1].first, dives[0].second);
  EXPECT_NEAR(static_cast<double>(dives[0].second), 90.0, 1.0);  // within 10 m of the surface
}

TEST(FindDives, ShallowDipsAreNoDives) {
  EXPECT_EQ(health::find_dives(std::vector<double>{0.0, 15.0, 0.0, 100.0, 0.0}).size(), 1U);
  EXPECT_TRUE(health::find_dives(std::vector<double>{}).empty());
  EXPECT_TRUE(health::find_dives(std::vector<double>(10, 0.0)).empty());
}

}  // namespace
}  // namespace kelpie::episode_test
