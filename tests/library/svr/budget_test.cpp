// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/resources.hpp"

#include <gtest/gtest.h>

namespace kelpie::budget_test {
namespace {

TEST(Budget, SharesWorkAndKeepsSomeForOthers) {
  Work left = 100;
  Budget first = Budget().sharing(left, 40);
  Budget second = Budget().sharing(left, 0);
  EXPECT_TRUE(first.spend(50));
  EXPECT_TRUE(first.spend(50));  // 10 were left to it: a step that has begun is ended
  EXPECT_FALSE(first.spend(1));
  EXPECT_EQ(left, 0);
  EXPECT_FALSE(second.goes_on());
  left = 100;  // NOLINT(clang-analyzer-deadcode.DeadStores): the budgets hold a reference
  EXPECT_FALSE(first.goes_on()) << "never again";
  EXPECT_FALSE(first.within(5).goes_on());
}

TEST(Budget, LeavesHalfOfWhatThereIs) {
  Work left = 100;
  const Budget all = Budget().sharing(left, 20);
  Budget half = all.split_half();
  EXPECT_TRUE(half.spend(40));
  EXPECT_FALSE(half.spend());
  EXPECT_EQ(left, 60);
  EXPECT_TRUE(Budget(all).spend());
  EXPECT_TRUE(Budget().split_half().spend(1'000'000)) << "nothing shared, nothing kept";
}

}  // namespace
}  // namespace kelpie::budget_test
