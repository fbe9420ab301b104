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

}  // namespace
}  // namespace kelpie::budget_test
