// SPDX-License-Identifier: Apache-2.0
#include "bag/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kelpie/core/random.hpp"

namespace kelpie::statistics_test {
namespace {

TEST(Statistics, TellsTheNoiseOnASlowMotionWhateverTheOutliers) {
  for (const std::size_t count : {200U, 5'000U, 100'000U}) {
    RandomStream random(7, "noise");
    bag::Statistics statistics;
    for (std::size_t k = 0; k < count; ++k) {
      const double outlier = k % 97 == 0 ? 1e6 : 0.0;
      statistics.add(std::sin(0.01 * static_cast<double>(k)) + 0.05 * random.normal() + outlier);
    }
    ASSERT_TRUE(statistics.noise());
    EXPECT_NEAR(*statistics.noise(), 0.05, 0.012) << count;
  }
}

TEST(Statistics, ValuesThatAreNoneSplitWhatComesBeforeFromWhatComesAfter) {
  bag::Statistics statistics;
  for (int k = 0; k < 100; ++k) {
    statistics.add(k < 50 ? 1.0 : 1000.0);
    if (k % 2 == 1) {
      statistics.add(std::numeric_limits<double>::quiet_NaN());
    }
  }
  EXPECT_FALSE(statistics.noise());  // never three on end
  EXPECT_EQ(statistics.finite(), 100U);
  EXPECT_EQ(statistics.not_finite(), 50U);
  EXPECT_EQ(statistics.low(), 1.0);
  EXPECT_EQ(statistics.high(), 1000.0);
}

}  // namespace
}  // namespace kelpie::statistics_test
