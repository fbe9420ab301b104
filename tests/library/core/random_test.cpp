// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace kelpie::random_test {
namespace {

TEST(RandomStream, SameSeedAndNameGiveTheSameNumbersEverywhere) {
  RandomStream a(7, "noise");
  RandomStream b(7, "noise");
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(a.uniform(), b.uniform());
    EXPECT_EQ(a.normal(), b.normal());
  }
  // Written down once, so that a change of the generator can't go unnoticed: saved experiments
  // would no longer be repeatable.
  RandomStream c(1, "split");
  EXPECT_EQ(c.below(1'000'000), 810'616U);
  EXPECT_EQ(c.below(1'000'000), 342'810U);
}

TEST(RandomStream, SeedsAndNamesAreIndependent) {
  constexpr int kDraws = 20'000;
  const auto correlation = [](RandomStream a, RandomStream b) {
    double sum = 0.0;
    for (int i = 0; i < kDraws; ++i) {
      sum += a.normal() * b.normal();
    }
    return sum / kDraws;
  };
  const double bound = 5.0 / std::sqrt(kDraws);
  EXPECT_LT(std::abs(correlation({1, "noise"}, {2, "noise"})), bound);
  EXPECT_LT(std::abs(correlation({1, "noise"}, {1, "commands"})), bound);
  EXPECT_GT(correlation({1, "noise"}, {1, "noise"}), 0.9);
}

TEST(RandomStream, HasTheMomentsOfItsDistributions) {
  RandomStream random(3, "moments");
  constexpr int kDraws = 200'000;
  double mean = 0.0;
  double square = 0.0;
  double fourth = 0.0;
  double uniform = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    mean += z / kDraws;
    square += z * z / kDraws;
    fourth += z * z * z * z / kDraws;
    const double u = random.uniform(2.0, 4.0);
    ASSERT_GE(u, 2.0);
    ASSERT_LT(u, 4.0);
    uniform += u / kDraws;
  }
  EXPECT_NEAR(mean, 0.0, 0.01);
  EXPECT_NEAR(square, 1.0, 0.02);
  EXPECT_NEAR(fourth, 3.0, 0.15);
  EXPECT_NEAR(uniform, 3.0, 0.01);
}

TEST(RandomStream, ShuffleIsAPermutationThatReachesEveryPlace) {
  RandomStream random(5, "shuffle");
  std::vector<int> first_places(4, 0);
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<int> items{0, 1, 2, 3};
    random.shuffle(std::span(items));
    ++first_places[static_cast<std::size_t>(items.front())];
    std::ranges::sort(items);
    ASSERT_EQ(items, (std::vector<int>{0, 1, 2, 3}));
  }
  for (const int count : first_places) {
    EXPECT_NEAR(count, 1000, 140);
  }
}

}  // namespace
}  // namespace kelpie::random_test
