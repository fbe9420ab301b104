// SPDX-License-Identifier: Apache-2.0
#include "model/warm_up.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "allocation_count.hpp"
#include "saved_state.hpp"

namespace kelpie::warm_up_test {
namespace {

void hold(WarmUp& warm_up, int first, int last) {
  for (int i = first; i < last; ++i) {
    warm_up.hold(std::array{1.0 * i, -1.0 * i}, 0.5 * i, 10.0 * i);
  }
}

std::vector<double> times(const WarmUp& warm_up) {
  std::vector<double> list;
  for (std::size_t i = 0; i < warm_up.size(); ++i) {
    list.push_back(warm_up[i].t);
  }
  return list;
}

TEST(WarmUp, HoldsTheLastSamplesInOrder) {
  WarmUp warm_up(2, 3);
  hold(warm_up, 0, 2);
  EXPECT_FALSE(warm_up.full());
  hold(warm_up, 2, 5);
  EXPECT_TRUE(warm_up.full());
  EXPECT_EQ(times(warm_up), (std::vector<double>{20.0, 30.0, 40.0}));
  EXPECT_EQ(warm_up[1].x[0], 3.0);
  EXPECT_EQ(warm_up[1].x[1], -3.0);
  EXPECT_EQ(warm_up[1].y, 1.5);
}

TEST(WarmUp, SamplesLeaveFromTheFrontOrAsOneLikes) {
  WarmUp warm_up(2, 6);
  hold(warm_up, 0, 6);
  warm_up.keep({true, false, true, true, false, true});
  EXPECT_EQ(times(warm_up), (std::vector<double>{0.0, 20.0, 30.0, 50.0}));
  warm_up.drop_oldest(2);
  EXPECT_EQ(times(warm_up), (std::vector<double>{30.0, 50.0}));
  EXPECT_EQ(warm_up[1].x[1], -5.0);
  EXPECT_EQ(warm_up[1].y, 2.5);
}

TEST(WarmUp, AllocatesInTheConstructorOnly) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  WarmUp warm_up(2, 50);
  const std::size_t before = testing::allocations;
  hold(warm_up, 0, 120);
  EXPECT_EQ(testing::allocations, before);
}

TEST(WarmUp, IsSavedAndLoaded) {
  testing::expect_same_life([] { return WarmUp(2, 5); }, 9, [](std::size_t) { return true; },
                            [](WarmUp& warm_up, std::size_t i) {
                              hold(warm_up, static_cast<int>(i), static_cast<int>(i) + 1);
                            });
}

}  // namespace
}  // namespace kelpie::warm_up_test
