// SPDX-License-Identifier: Apache-2.0
#include "learner/member_shares.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
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

// After hours of an accurate model its usual loss is tiny: a single block of a changed vehicle, in
// which another member happens to be less wrong, is not taken for all there is to know.
TEST(MemberShares, OneBlockAfterAChangeDecidesLittle) {
  MemberShares shares(kAlike);
  score(shares, {0.001, 0.02, 1.0}, 5000);
  EXPECT_GT(shares.shares()[0], 0.99);
  score(shares, {1.0, 0.7, 1.0}, 20);
  EXPECT_LT(shares.shares()[1], 0.65);
  score(shares, {1.0, 0.7, 1.0}, 400);
  EXPECT_GT(shares.shares()[1], 0.65);
}

// In the first minute a member that has learned meanwhile is not held to what it said at first.
TEST(MemberShares, AMemberThatHasLearnedIsBelievedSoon) {
  MemberShares shares(kAlike);
  score(shares, {1.0, 0.6, 0.6}, 60);
  EXPECT_LT(shares.shares()[0], 0.3);
  score(shares, {0.2, 0.6, 0.6}, 140);
  EXPECT_GT(shares.shares()[0], 0.7);
}

// One absurd sample counts as ten standard deviations, whatever it is.
TEST(MemberShares, WhatIsNoNumberIsNoBetterThanTheWorst) {
  MemberShares shares(kAlike);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  score(shares, {nan, infinity, 10.0}, 20);
  for (const double share : shares.shares()) {
    EXPECT_DOUBLE_EQ(share, 1.0 / 3.0);
  }
}

TEST(MemberShares, ABlockOfMembersThatAreNoMoreSaysNothing) {
  MemberShares shares(kAlike);
  score(shares, {2.0, 0.1, 0.1}, 15);
  shares.start_block();
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

TEST(MemberShares, GoesOnWithSharesWhateverErrorsAreUsual) {
  MemberShares shares(kAlike);
  shares.resume_from(std::array{0.6, 0.3, 0.1});
  score(shares, {0.01, 0.01, 0.01}, 20);
  EXPECT_NEAR(shares.shares()[0], 0.6, 0.02);
  EXPECT_NEAR(shares.shares()[2], 0.1, 0.02);
}

// A calm vehicle manoeuvres at one sample in a hundred, which one member knows.
TEST(MemberShares, RareManoeuvresDecide) {
  MemberShares shares(kAlike);
  for (int i = 0; i < 3000; ++i) {
    shares.score(i % 100 == 0 ? std::array{2.0, 0.3, 2.0} : std::array{0.10, 0.11, 0.10});
  }
  EXPECT_GT(shares.shares()[1], 0.7);
}

// Discounted losses of the shares and of the members, and the bound of their difference
// (docs/method/posterior.md, Mixture), computed from shares and errors alone.
class Regret {
 public:
  explicit Regret(std::size_t members) : losses_(members) {}

  void add(std::span<const double> shares, std::span<const double> errors) {
    double all = 0.0;
    double square = 0.0;
    const double keep = std::min(kKeep, 1.0 - 1.0 / ++blocks_);
    for (std::size_t k = 0; k < losses_.size(); ++k) {
      const double loss = std::pow(errors[k], 1.5);
      all += shares[k] * loss;
      square += shares[k] * loss * loss;
      losses_[k] = keep * losses_[k] + loss;
    }
    all_ = keep * all_ + all;
    square_ = keep * keep * square_ + all * all;
    const double known =
        std::min(1.0 - std::pow(kKeep, blocks_), 4.0 / 3.0 * (1.0 - kKeep) * all_ * all_ / square_);
    const double width = all_ / (kRate * std::sqrt(known));
    const double before = blocks_ > 1.0 ? width_ : width;
    growth_ = keep * growth_ + std::max(before - width, 0.0);
    squares_ = keep * squares_ + square / (2.0 * before * (blocks_ > 1.0 ? keep : 1.0));
    width_ = width;
  }

  double value() const { return all_ - *std::ranges::min_element(losses_); }
  double bound() const {
    return std::log(static_cast<double>(losses_.size())) * (width_ + growth_) + squares_;
  }
  double all() const { return all_; }

 private:
  static constexpr double kKeep = 0.98;
  static constexpr double kRate = 5.0;
  std::vector<double> losses_;
  double all_ = 0.0;
  double square_ = 0.0;  ///< of the shares' losses of a block
  double blocks_ = 0.0;
  double width_ = 0.0;  ///< 1/η
  double growth_ = 0.0;
  double squares_ = 0.0;
};

// Who makes the members' errors knows the shares.
TEST(MemberShares, RegretAgainstTheBestMemberIsBoundedOnHostileStreams) {
  using Errors = std::array<double, 6>;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  const std::vector<std::function<double(int, std::size_t, std::span<const double>)>> streams{
      [](int, std::size_t k, std::span<const double> shares) {  // the most believed is wrong
        return k == std::size_t(std::ranges::max_element(shares) - shares.begin()) ? 2.9 : 0.3;
      },
      [](int block, std::size_t k, std::span<const double>) {  // the best member changes
        return k == std::size_t(block / 40) % 6 ? 0.05 : 0.8;
      },
      [](int block, std::size_t k,
         std::span<const double>) {  // errors grow and shrink a hundredfold
        return (1.0 + 0.2 * double(k)) * (block / 30 % 2 == 0 ? 0.01 : 1.0);
      },
      [&](int, std::size_t, std::span<const double>) {  // rare and large
        return uniform(random) < 0.03 ? 2.9 : 0.1 * uniform(random);
      },
  };
  for (std::size_t s = 0; s < streams.size(); ++s) {
    Errors first;
    first.fill(1.0 / 6.0);
    MemberShares shares(first);
    Regret regret(first.size());
    for (int block = 0; block < 600; ++block) {
      Errors errors{};
      for (std::size_t k = 0; k < errors.size(); ++k) {
        errors[k] = streams[s](block, k, shares.shares());
      }
      regret.add(shares.shares(), errors);
      for (std::size_t i = 0; i < MemberShares::kBlock; ++i) {
        shares.score(errors);
      }
      ASSERT_LE(regret.value(), regret.bound() + 1e-9) << "stream " << s << ", block " << block;
    }
    if (s < 3) {  // in the last stream the best member is so by luck
      EXPECT_LE(regret.value(), 0.5 * regret.all()) << "stream " << s;
    }
  }
}

}  // namespace
}  // namespace kelpie::member_shares_test
