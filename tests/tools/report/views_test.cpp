// SPDX-License-Identifier: Apache-2.0
#include "report/stream_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

std::vector<chart::Point> course(const study::AxisResult& axis, report::Clock clock = {}) {
  return report::over_time(clock, axis.held_out_time_s, axis.held_out_true);
}

TEST(OverTime, BreaksALineAtGapsButNotWhereOneRowIsMissing) {
  study::AxisResult axis = in_blocks();
  EXPECT_EQ(breaks(course(axis)), 4U);
  EXPECT_EQ(course(axis).size(), 504U);
  axis.held_out_time_s.erase(axis.held_out_time_s.begin() + 50);
  axis.held_out_true.erase(axis.held_out_true.begin() + 50);
  EXPECT_EQ(breaks(course(axis)), 4U);
  EXPECT_FALSE(report::scattered(axis.held_out_time_s));
  const std::vector<chart::Point> points = course(axis);
  EXPECT_TRUE(std::ranges::is_sorted(points, {}, &chart::Point::x));
}

TEST(OverTime, RowsThatStandAloneAreToldFromStretches) {
  std::vector<double> times;
  for (int i = 0; i < 500; ++i) {
    times.push_back(0.25 * (5 * i + (i * i) % 7));
  }
  EXPECT_TRUE(report::scattered(times));
}

TEST(Clock, CountsLargeTimeStampsFromTheStart) {
  study::StreamResult result = synthetic::stream(2);
  EXPECT_EQ(report::clock_of(result).axis().label, "time in s");
  for (study::AxisResult& axis : result.axes) {
    for (double& time : axis.held_out_time_s) {
      time += 1.7e9 + 0.5;
    }
  }
  result.axes[0].validation.clear();
  result.axes[1].validation.clear();
  const report::Clock clock = report::clock_of(result);
  EXPECT_EQ(clock.axis().range->low, 0.5);
  EXPECT_EQ(clock.axis().label, "time in s after 1700000000 s");
  EXPECT_EQ(course(result.axes[0], clock).front().x, 0.5);
  EXPECT_EQ(report::clock_of({}).origin_s, 0.0);
}

TEST(Scatter, IsThinnedEvenlyAndLeavesOutWhatIsNotFinite) {
  study::AxisResult axis = synthetic::axis("a", 100, 5000);
  axis.held_out_predicted[0] = NAN;
  std::iota(axis.held_out_true.begin(), axis.held_out_true.end(), 0.0);
  const std::vector<report::ScatterDot> points = report::scatter_of(axis, 1000);
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
      EXPECT_GE(interval.from_s, last);
      last = interval.to_s;
      for (const TallyField& field : tally_fields()) {
        total.*field.total += interval.done.*field.total;
      }
    }
    EXPECT_EQ(last, 500.0);
    for (const TallyField& field : tally_fields()) {
      EXPECT_EQ(total.*field.total, everything.*field.total) << field.key;
    }
  }
  EXPECT_TRUE(report::intervals_of(study::AxisResult{}, 10).empty());
}

TEST(Events, StandAtTheFirstRowOfAConfigurationAndWhereErrorsBeganToGrow) {
  study::AxisResult axis = synthetic::axis("a", 300, 10);
  axis.validation[4].configuration = axis.validation[5].configuration = 2;
  axis.changes = {{120, 30.0, 28.0, 0, 0}, {240, 60.0, 58.0, 2, 0}};
  const std::vector<report::Event> found = report::events_of(axis);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].name, "change");
  EXPECT_EQ(found[0].time_s, 28.0);
  EXPECT_EQ(found[1].name, "known again");
  EXPECT_EQ(found[1].time_s, 58.0);
  EXPECT_EQ(found[2].name, "configuration 2");
  EXPECT_EQ(found[2].time_s, 62.5) << "no row is known, only the look";
  // Trained rows know it from 55 s on, held-out rows from 51 s on; the one at 20 s is of before.
  axis.one_step.time_s = {49.0, 55.0, 56.0};
  axis.one_step.configuration = {1, 2, 2};
  axis.stages = {{2, 300, 0.9, {20.0, 51.0, 52.0}, {}, {}}};
  EXPECT_EQ(report::events_of(axis)[1].time_s, 51.0);
}

TEST(Histogram, CountsEveryUpdateOnceInItsBin) {
  study::AxisResult axis = synthetic::axis("a", 3000, 10);
  axis.update_us[0] = axis.update_us[1] = 0.0;
  axis.update_us[2] = NAN;
  const report::TimeHistogram histogram = report::histogram_of(axis);
  double sum = 0.0;
  for (const chart::Point& bin : histogram.bins) {
    sum += bin.y;
  }
  EXPECT_EQ(sum, 2999.0);
  EXPECT_EQ(histogram.zeros, 2U);
  const double last = *std::ranges::max_element(axis.update_us);
  EXPECT_NEAR(std::log10(histogram.bins.back().x), std::log10(last), 0.0501);
}

TEST(Histogram, OfConstantOrZeroOrNoTimesSpansADecade) {
  for (const double time : {0.0, 300.0, 1000.0}) {
    study::AxisResult axis;
    axis.update_us.assign(5, time);
    const report::TimeHistogram histogram = report::histogram_of(axis);
    EXPECT_EQ(histogram.bins.size(), 10U);
    EXPECT_EQ(histogram.bins.front().y, 5.0) << time;
  }
  EXPECT_TRUE(report::histogram_of(study::AxisResult{}).bins.empty());
}

}  // namespace
}  // namespace kelpie::views_test
