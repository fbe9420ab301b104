// SPDX-License-Identifier: Apache-2.0
#include "svr/robust_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kelpie::robust_scale_test {
namespace {

TEST(RobustScale, IsKnownAfterEnoughErrorsAndIgnoresSpikes) {
  RobustScale scale(64, 8);
  for (int i = 0; i < 63; ++i) {
    scale.add(i % 10 == 0 ? 50.0 : (i % 2 == 0 ? 0.1 : -0.1));
    EXPECT_TRUE(std::isinf(scale.value())) << i;
  }
  scale.add(0.1);
  EXPECT_NEAR(scale.value(), 0.14826, 1e-9);
}

TEST(RobustScale, FollowsTheLastErrorsOnly) {
  RobustScale scale(64, 8);
  for (int i = 0; i < 1000; ++i) {
    scale.add(0.1);
  }
  for (int i = 0; i < 256; ++i) {
    scale.add(2.0);
  }
  EXPECT_NEAR(scale.value(), 2.9652, 1e-9);
}

TEST(RobustScale, AClearedOneIsANewOne) {
  RobustScale scale(2, 1);
  scale.add(7.0);
  scale.add(7.0);
  scale.clear();
  EXPECT_TRUE(std::isinf(scale.value()));
  scale.add(1.0);
  scale.add(1.0);
  EXPECT_NEAR(scale.value(), 1.4826, 1e-9);
}

}  // namespace
}  // namespace kelpie::robust_scale_test
