// SPDX-License-Identifier: Apache-2.0
#include "learner/seen_range.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::seen_range_test {
namespace {

TEST(SeenRange, IsThatOfTheTargetsAndATenthOfItsWidth) {
  RandomStream random(1, "seen");
  SeenRange seen(0.1);
  EXPECT_TRUE(std::isinf(seen.range().high));
  for (int i = 0; i < 1000; ++i) {
    seen.add(random.uniform(-1.0, 3.0));
  }
  EXPECT_NEAR(seen.range().low, -1.4, 0.05);
  EXPECT_NEAR(seen.range().high, 3.4, 0.05);
}

// A model of the first few samples may say anything elsewhere.
TEST(SeenRange, BoundsFromTheFirstTargetOn) {
  SeenRange seen(0.1);
  seen.add(0.3);
  EXPECT_DOUBLE_EQ(seen.range().low, -0.7);
  seen.add(0.8);
  EXPECT_DOUBLE_EQ(seen.range().low, -0.7);
  EXPECT_DOUBLE_EQ(seen.range().high, 1.8);
}

TEST(SeenRange, TwoAbsurdTargetsDoNotMoveIt) {
  RandomStream random(1, "seen");
  SeenRange clean(0.1);
  SeenRange struck(0.1);
  for (int i = 0; i < 1000; ++i) {
    const double y = random.uniform(-1.0, 3.0);
    clean.add(y);
    struck.add(y);
    if (i == 3 || i == 700) {
      struck.add(1e30);
      struck.add(-1e30);
    }
  }
  EXPECT_NEAR(struck.range().low, clean.range().low, 0.1);
  EXPECT_NEAR(struck.range().high, clean.range().high, 0.1);
}

// Terms stand last in a sample; an empty set has no limits.
TEST(SeenTermRanges, FollowTheTermsOfSamplesAndTheirScale) {
  SeenTermRanges seen(2);
  for (int i = 0; i <= 100; ++i) {
    seen.add(std::array{1e6, 0.01 * i, -1.0 + 0.02 * i});
  }
  EXPECT_NEAR(seen.ranges()[0].low, -0.5, 0.05);
  EXPECT_NEAR(seen.ranges()[1].high, 2.0, 0.1);
  const std::vector<ValueRange> before = seen.ranges();
  seen.rescale(std::array{10.0, 1.0});
  EXPECT_NEAR(seen.ranges()[0].low, 10.0 * before[0].low, 1e-12);
  EXPECT_NEAR(seen.ranges()[1].high, before[1].high, 1e-12);
  SeenTermRanges none(0);
  none.add(std::array{1e6, 1.0, 2.0});
  EXPECT_TRUE(none.ranges().empty());
}

}  // namespace
}  // namespace kelpie::seen_range_test
