// SPDX-License-Identifier: Apache-2.0
#include "study/metrics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace kelpie::metrics_test {
namespace {

TEST(RSquared, KnowsItsLandmarks) {
  const std::array truth{1.0, 2.0, 3.0, 4.0};
  EXPECT_EQ(study::r_squared(truth, truth), 1.0);
  EXPECT_EQ(study::r_squared(truth, std::array{2.5, 2.5, 2.5, 2.5}), 0.0);
  EXPECT_DOUBLE_EQ(study::r_squared(truth, std::array{4.0, 3.0, 2.0, 1.0}), -3.0);
  EXPECT_TRUE(std::isnan(study::r_squared(std::array{2.0, 2.0}, std::array{2.0, 2.0})));
  EXPECT_TRUE(std::isnan(study::r_squared({}, {})));
}

}  // namespace
}  // namespace kelpie::metrics_test
