// SPDX-License-Identifier: Apache-2.0
#include "fleet/trend.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kelpie/core/random.hpp"

namespace kelpie::trend_test {
namespace {

fleet::Trend judged(std::vector<double> r2) {
  fleet::Trend trend;
  trend.r2 = std::move(r2);
  fleet::judge(trend);
  return trend;
}

std::vector<double> falling(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.rbegin(), values.rend(), 0.0);
  return values;
}

// S = −45, its variance 125: z = 44 / √125.
TEST(Trend, HasTheChanceOfMannAndKendallsTest) {
  EXPECT_NEAR(judged(falling(10)).chance, std::erfc(44.0 / std::sqrt(125.0) / std::sqrt(2.0)),
              1e-15);
  EXPECT_EQ(judged(falling(10)).early, 8.0);
  EXPECT_EQ(judged(falling(10)).late, 1.0);
  EXPECT_EQ(judged(std::vector<double>(12, 0.5)).chance, 1.0);
  EXPECT_TRUE(std::isnan(judged(falling(9)).chance));
}

TEST(Trend, WhereThereIsNoneOneInTwentyPassesForOne) {
  RandomStream random(1, "trend");
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> values(15);
    std::ranges::generate(values, [&] { return random.normal(); });
    found += judged(values).chance < 0.05 ? 1 : 0;
  }
  EXPECT_GE(found, 25);
  EXPECT_LE(found, 75);
}

TEST(Trend, StandsOutByHowManyWereTestedAndByItsSize) {
  EXPECT_TRUE(fleet::stands_out(judged(falling(10)), 100));
  EXPECT_FALSE(fleet::stands_out(judged(falling(10)), 1000));
  std::vector<double> tiny = falling(10);
  std::ranges::transform(tiny, tiny.begin(), [](double value) { return 0.9 + 1e-4 * value; });
  EXPECT_FALSE(fleet::stands_out(judged(tiny), 1));
  EXPECT_FALSE(fleet::stands_out(judged(falling(9)), 1));
}

}  // namespace
}  // namespace kelpie::trend_test
