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

// A change that was taken back, or whose cause is still looked for, divides no rows.
TEST(Summary, TheLastChangeThatStandsDividesTheHeldOutRows) {
  study::StreamResult result;
  study::AxisResult axis;
  axis.stages = {{.time_s = {1.0, 2.0, 3.0, 4.0},
                  .truth = {0.0, 1.0, 0.0, 1.0},
                  .predicted = {1.0, 0.0, 0.0, 1.0}}};
  EXPECT_FALSE(study::since_change(result, axis));
  axis.changes = {{.since_s = 2.5}, {.since_s = 3.5, .withdrawn = 9}};
  const auto since = study::since_change(result, axis);
  ASSERT_TRUE(since);
  EXPECT_EQ(since->since_s, 2.5);
  EXPECT_EQ(since->before, 2U);
  EXPECT_EQ(since->rows, 2U);
  EXPECT_EQ(since->r2, 1.0);
  Finding finding;
  finding.since_s = 3.5;
  result.diagnosis.findings = {finding};
  EXPECT_EQ(study::since_change(result, axis)->since_s, 2.5);
  result.diagnosis.findings.front().state = FindingState::named;
  EXPECT_EQ(study::since_change(result, axis)->since_s, 3.5);
  axis.changes = {{.since_s = 0.5}};
  result.diagnosis.findings.clear();
  EXPECT_FALSE(study::since_change(result, axis)) << "no row before";
}

}  // namespace
}  // namespace kelpie::summary_test
