// SPDX-License-Identifier: Apache-2.0
#include "study/summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kelpie::summary_test {
namespace {

// Values of numpy.quantile.
TEST(Summary, QuantilesLeaveOutWhatWasNotMeasured) {
  const std::vector<double> values{4.0, NAN, 1.0, 3.0, INFINITY, 2.0};
  const study::Quantiles found = study::quantiles_of(values);
  EXPECT_DOUBLE_EQ(found.median, 2.5);
  EXPECT_DOUBLE_EQ(found.p99, 3.97);
  EXPECT_DOUBLE_EQ(found.p999, 3.997);
  EXPECT_EQ(found.max, 4.0);
  EXPECT_TRUE(std::isnan(study::quantiles_of({}).median));
  EXPECT_TRUE(std::isnan(study::quantiles_of(std::vector<double>{NAN}).max));
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
