// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/member_shares.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace kelpie::member_shares_test {
namespace {

void judge(MemberShares& shares, const std::array<double, 3>& errors, int samples) {
  for (int i = 0; i < samples; ++i) {
    shares.judge(errors);
  }
}

TEST(MemberShares, AllAreBelievedAlikeUntilABlockHasEnded) {
  MemberShares shares(3);
  judge(shares, {0.1, 0.5, 2.0}, 19);
  EXPECT_DOUBLE_EQ(shares.shares()[0], 1.0 / 3.0);
  EXPECT_FALSE(shares.block_ended());
  judge(shares, {0.1, 0.5, 2.0}, 1);
  EXPECT_TRUE(shares.block_ended());
  EXPECT_GT(shares.shares()[0], shares.shares()[1]);
  EXPECT_GT(shares.shares()[1], shares.shares()[2]);
  EXPECT_NEAR(std::accumulate(shares.shares().begin(), shares.shares().end(), 0.0), 1.0, 1e-12);
}

// The vehicle changes, and another member suits it: belief moves within some tens of samples.
TEST(MemberShares, BeliefFollowsWhoIsRightNow) {
  MemberShares shares(3);
  judge(shares, {0.1, 0.6, 1.0}, 5000);
  EXPECT_GT(shares.shares()[0], 0.99);
  judge(shares, {1.5, 0.1, 1.0}, 1000);
  EXPECT_GT(shares.shares()[1], 0.9);
}

// One absurd sample counts as three standard deviations, whatever it is.
TEST(MemberShares, WhatIsNoNumberIsNoBetterThanTheWorst) {
  MemberShares shares(3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  judge(shares, {nan, infinity, 3.0}, 20);
  for (const double share : shares.shares()) {
    EXPECT_DOUBLE_EQ(share, 1.0 / 3.0);
  }
}

TEST(MemberShares, ABlockOfMembersThatAreNoMoreSaysNothing) {
  MemberShares shares(3);
  judge(shares, {2.0, 0.1, 0.1}, 15);
  shares.restart_block();
  judge(shares, {0.1, 0.1, 0.1}, 20);
  EXPECT_DOUBLE_EQ(shares.shares()[0], shares.shares()[1]);
}

}  // namespace
}  // namespace kelpie::member_shares_test
