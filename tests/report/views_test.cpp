// SPDX-License-Identifier: Apache-2.0
#include "report/views.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "report/synthetic.hpp"

namespace kelpie::views_test {
namespace {

std::size_t breaks(const std::vector<chart::Point>& points) {
  std::size_t count = 0;
  for (const chart::Point& point : points) {
    count += std::isnan(point.y) ? 1U : 0U;
  }
  return count;
}

// Blocks of 100 rows at 4 Hz with 400 rows left out between them.
study::AxisResult in_blocks() {
  study::AxisResult axis = synthetic::axis("a", 100, 500);
  for (std::size_t i = 0; i < 500; ++i) {
    const std::size_t block = i / 100;
    axis.held_out_time_s[i] = 0.25 * static_cast<double>(i + 400 * block);
  }
  return axis;
}

TEST(Stretch, IsTakenFromWithinOneBlockWherePossible) {
  const report::Stretch stretch = report::stretch_of(in_blocks(), 4.0, 80);
  EXPECT_EQ(stretch.truth.size(), 80U);
  EXPECT_EQ(breaks(stretch.truth), 0U);
  EXPECT_FALSE(stretch.scattered);
  EXPECT_NEAR(stretch.truth.back().x - stretch.truth.front().x, 79 * 0.25, 1e-9);
}

TEST(Stretch, IsBrokenAtGapsInTimeWithOrWithoutAKnownRate) {
  for (const double rate : {4.0, 0.0}) {
    const report::Stretch stretch = report::stretch_of(in_blocks(), rate, 150);
    EXPECT_EQ(breaks(stretch.truth), 1U) << rate;
    EXPECT_EQ(breaks(stretch.predicted), 1U) << rate;
    EXPECT_EQ(stretch.truth.size(), 151U);
  }
}

TEST(Stretch, OfScatteredRowsJoinsNothing) {
  study::AxisResult axis = synthetic::axis("a", 100, 500);
  for (std::size_t i = 0; i < 500; ++i) {
    axis.held_out_time_s[i] = 0.25 * static_cast<double>(5 * i + i % 3);
  }
  const report::Stretch stretch = report::stretch_of(axis, 4.0, 300);
  EXPECT_TRUE(stretch.scattered);
  EXPECT_EQ(stretch.truth.size(), 300U);
  EXPECT_EQ(breaks(stretch.truth), 0U);
}

TEST(Stretch, CountsLargeTimeStampsFromItsOwnStart) {
  study::AxisResult axis = synthetic::axis("a", 100, 50);
  for (double& time : axis.held_out_time_s) {
    time += 1.7e9;
  }
  const report::Stretch stretch = report::stretch_of(axis, 4.0, 50);
  EXPECT_EQ(stretch.origin_s, 1.7e9);
  EXPECT_EQ(stretch.truth.front().x, 0.0);
  EXPECT_TRUE(report::stretch_of(study::AxisResult{}, 4.0, 50).truth.empty());
}

TEST(Scatter, IsThinnedEvenlyAndLeavesOutWhatIsNotFinite) {
  study::AxisResult axis = synthetic::axis("a", 100, 5000);
  axis.held_out_predicted[0] = NAN;
  std::iota(axis.held_out_true.begin(), axis.held_out_true.end(), 0.0);
  const std::vector<chart::Point> points = report::scatter_of(axis, 1000);
  ASSERT_EQ(points.size(), 1000U);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].x - points[i - 1].x, 5.0, 1.0);
  }
  EXPECT_EQ(report::scatter_of(axis, 10'000).size(), 4999U);
}

TEST(Intervals, TogetherHoldEverythingTheNodesDid) {
  study::AxisResult axis = synthetic::axis("a", 2000, 10);
  std::int64_t step = 0;
  for (const TallyField& field : tally_fields()) {
    ++step;
    for (std::size_t i = 0; i < axis.validation.size(); ++i) {
      axis.validation[i].status.tally.*field.total = step * static_cast<std::int64_t>(i + 1);
    }
  }
  const Tally& everything = axis.validation.back().status.tally;
  for (const std::size_t most : {7U, 40U, 1000U}) {
    const std::vector<report::Interval> intervals = report::intervals_of(axis, most);
    EXPECT_EQ(intervals.size(), std::min<std::size_t>(most, 40U));
    // NOLINTNEXTLINE(misc-const-correctness): written to through pointers to members
    Tally total;
    double last = 0.0;
    for (const report::Interval& interval : intervals) {
      EXPECT_EQ(interval.from, last);
      last = interval.to;
      for (const TallyField& field : tally_fields()) {
        total.*field.total += interval.done.*field.total;
      }
    }
    EXPECT_EQ(last, 2000.0);
    for (const TallyField& field : tally_fields()) {
      EXPECT_EQ(total.*field.total, everything.*field.total) << field.key;
    }
  }
  EXPECT_TRUE(report::intervals_of(study::AxisResult{}, 10).empty());
}

TEST(Switches, StandWhereTheOldConfigurationWasLastSeen) {
  study::AxisResult axis = synthetic::axis("a", 300, 10);
  axis.validation[4].configuration = axis.validation[5].configuration = 2;
  const std::vector<report::Switch> found = report::switches(axis);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].samples, 200.0);
  EXPECT_EQ(found[0].configuration, 2);
}

TEST(Histogram, CountsEveryUpdateOnceInItsBin) {
  study::AxisResult axis = synthetic::axis("a", 3000, 10);
  axis.update_us[0] = axis.update_us[1] = 0.0;
  axis.update_us[2] = NAN;
  const report::TimeHistogram histogram = report::histogram_of(axis);
  EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), 0.0), 2999.0);
  EXPECT_EQ(histogram.zeros, 2U);
  EXPECT_NEAR(report::bin_edges(histogram, histogram.counts.size() - 1).high,
              histogram.range_us.high, 1e-6 * histogram.range_us.high);
}

TEST(Histogram, OfConstantOrZeroOrNoTimesSpansADecade) {
  for (const double time : {0.0, 300.0, 1000.0}) {
    study::AxisResult axis;
    axis.update_us.assign(5, time);
    const report::TimeHistogram histogram = report::histogram_of(axis);
    EXPECT_NEAR(histogram.range_us.high / histogram.range_us.low, 10.0, 1e-9);
    EXPECT_EQ(histogram.counts.front(), 5.0) << time;
  }
  EXPECT_TRUE(report::histogram_of(study::AxisResult{}).counts.empty());
}

}  // namespace
}  // namespace kelpie::views_test
