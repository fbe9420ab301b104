// SPDX-License-Identifier: Apache-2.0
#include "study/summary.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace kelpie::summary_test {
namespace {

TEST(Summary, NearestRankAgreesWithAPersonCounting) {
  const std::vector<double> values = {4.0, 1.0, 3.0, 2.0};
  EXPECT_EQ(study::nearest_rank(values, 0.5), 2.0);
  EXPECT_EQ(study::nearest_rank(values, 0.51), 3.0);
  EXPECT_EQ(study::nearest_rank(values, 0.99), 4.0);
  EXPECT_TRUE(std::isnan(study::nearest_rank({}, 0.5)));
  const std::vector<double> one = {NAN, 7.0};
  EXPECT_EQ(study::nearest_rank(one, 0.01), 7.0);
}

RC_GTEST_PROP(Summary, NearestRankIsTheLeastValueThatEnoughOthersDoNotExceed, ()) {
  const auto values = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(
      rc::gen::map(rc::gen::inRange(0, 50), [](int n) { return static_cast<double>(n); })));
  const double q = static_cast<double>(*rc::gen::inRange(1, 101)) / 100.0;
  const double found = study::nearest_rank(values, q);
  const auto share = [&](auto counts) {
    return static_cast<double>(std::count_if(values.begin(), values.end(), counts)) /
           static_cast<double>(values.size());
  };
  RC_ASSERT(std::find(values.begin(), values.end(), found) != values.end());
  RC_ASSERT(share([&](double v) { return v <= found; }) >= q - 1e-12);
  RC_ASSERT(share([&](double v) { return v < found; }) < q + 1e-12);
}

TEST(Summary, R2WithoutAModelInServiceIsNotANumber) {
  study::ValidationPoint point;
  point.r2 = 0.4;
  EXPECT_TRUE(std::isnan(study::served_r2(point)));
  point.status.ready = true;
  EXPECT_EQ(study::served_r2(point), 0.4);
}

}  // namespace
}  // namespace kelpie::summary_test
