// SPDX-License-Identifier: Apache-2.0
#include "learner/member_shares.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace kelpie::member_shares_test {
namespace {

void score(MemberShares& shares, const std::array<double, 3>& errors, int samples) {
  for (int i = 0; i < samples; ++i) {
    shares.score(errors);
  }
}

constexpr std::array kAlike{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};

TEST(MemberShares, AllAreBelievedAlikeUntilABlockHasEnded) {
  MemberShares shares(kAlike);
  score(shares, {0.1, 0.5, 2.0}, 19);
  EXPECT_DOUBLE_EQ(shares.shares()[0], 1.0 / 3.0);
  EXPECT_FALSE(shares.block_ended());
  score(shares, {0.1, 0.5, 2.0}, 1);
  EXPECT_TRUE(shares.block_ended());
  EXPECT_GT(shares.shares()[0], shares.shares()[1]);
  EXPECT_GT(shares.shares()[1], shares.shares()[2]);
  EXPECT_NEAR(std::accumulate(shares.shares().begin(), shares.shares().end(), 0.0), 1.0, 1e-12);
}

// A prior says something for some hundred samples, and then errors alone do.
TEST(MemberShares, FirstSharesGiveWayToErrors) {
  MemberShares shares(std::array{0.05, 0.9, 0.05});
  EXPECT_NEAR(shares.shares()[1], 0.9, 1e-12);
  score(shares, {0.1, 0.1, 0.1}, 60);
  EXPECT_GT(shares.shares()[1], 0.5);
  score(shares, {0.1, 0.1, 0.1}, 6000);
  EXPECT_NEAR(shares.shares()[1], 1.0 / 3.0, 0.02);
  score(shares, {0.1, 0.2, 0.3}, 1000);
  EXPECT_GT(shares.shares()[0], 0.9);
}

// The vehicle changes, and another member suits it: belief moves within some tens of samples.
TEST(MemberShares, BeliefFollowsWhoIsRightNow) {
  MemberShares shares(kAlike);
  score(shares, {0.1, 0.6, 1.0}, 5000);
  EXPECT_GT(shares.shares()[0], 0.99);
  score(shares, {1.5, 0.1, 1.0}, 1000);
  EXPECT_GT(shares.shares()[1], 0.9);
}

// One absurd sample counts as three standard deviations, whatever it is.
TEST(MemberShares, WhatIsNoNumberIsNoBetterThanTheWorst) {
  MemberShares shares(kAlike);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  score(shares, {nan, infinity, 3.0}, 20);
  for (const double share : shares.shares()) {
    EXPECT_DOUBLE_EQ(share, 1.0 / 3.0);
  }
}

TEST(MemberShares, ABlockOfMembersThatAreNoMoreSaysNothing) {
  MemberShares shares(kAlike);
  score(shares, {2.0, 0.1, 0.1}, 15);
  shares.halve_evidence();
  score(shares, {0.1, 0.1, 0.1}, 20);
  EXPECT_DOUBLE_EQ(shares.shares()[0], shares.shares()[1]);
}

// A tenth of a usual error tells as much of a clean log as of a noisy one.
TEST(MemberShares, CountsErrorsAgainstTheUsualOne) {
  MemberShares noisy(kAlike);
  MemberShares clean(kAlike);
  score(noisy, {0.9, 1.0, 1.1}, 2000);
  score(clean, {0.09, 0.1, 0.11}, 2000);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(clean.shares()[k], noisy.shares()[k], 1e-9);
  }
  EXPECT_GT(clean.shares()[0], 0.5);
}

// While a vehicle that has changed isn't noticed, everybody is wrong, and who is less so is no
// better for it.
TEST(MemberShares, WhatHappensBetweenSuspicionAndChangeIsForgiven) {
  MemberShares shares(kAlike);
  score(shares, {0.2, 0.1, 0.3}, 2000);
  const std::vector<double> before(shares.shares().begin(), shares.shares().end());
  score(shares, {0.5, 2.0, 1.0}, 20);  // errors have grown within the block that ends here
  shares.mark_suspicion();
  score(shares, {0.5, 3.0, 1.0}, 200);
  ASSERT_GT(shares.shares()[0], shares.shares()[1]);
  shares.roll_back();
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(shares.shares()[k], before[k], 0.2 * before[k]);
  }
  const std::vector<double> forgiven(shares.shares().begin(), shares.shares().end());
  shares.roll_back();  // nothing was suspected since
  EXPECT_TRUE(std::ranges::equal(shares.shares(), forgiven));
}

TEST(MemberShares, GoesOnWithSharesWhateverErrorsAreUsual) {
  MemberShares shares(kAlike);
  shares.resume_from(std::array{0.6, 0.3, 0.1});
  score(shares, {0.01, 0.01, 0.01}, 20);
  EXPECT_NEAR(shares.shares()[0], 0.6, 0.02);
  EXPECT_NEAR(shares.shares()[2], 0.1, 0.02);
}

// Where all learn noise, the last member, the mean, gets the shares of the others.
TEST(MemberShares, WhatNeverComesTrueCountsLittle) {
  MemberShares shares(kAlike);
  for (int i = 0; i < 400; ++i) {
    shares.calibrate(i % 2 == 0 ? 0.5 : -0.5, 0.0, i % 3 == 0 ? 1.0 : -1.0);
    shares.score(std::array<double, 3>{1.0, 1.0, 1.0});
  }
  EXPECT_GT(shares.shares()[2], 0.85);
  EXPECT_GT(shares.shares()[0], 0.0);
  EXPECT_NEAR(std::accumulate(shares.shares().begin(), shares.shares().end(), 0.0), 1.0, 1e-12);
}

}  // namespace
}  // namespace kelpie::member_shares_test
