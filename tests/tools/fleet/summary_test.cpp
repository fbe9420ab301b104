// SPDX-License-Identifier: Apache-2.0
#include "fleet/summary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fleet/forged_study.hpp"
#include "fleet/tuning.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::summary_test {
namespace {

using testing::ForgedStudy;

TEST(StudySummary, CountsWhoIsBetterRunByRun) {
  ForgedStudy study;
  study.add_vehicle("one", 4);
  study.add_vehicle("two", 3);
  // Of `one`: kelpie is best, as good as best, worse than least squares, and never had a model.
  const std::vector<double> kelpie{0.9, 0.6, 0.3, fleet::kNoValue, 0.7, 0.7, 0.7};
  const std::vector<double> small{0.8, 0.605, 0.55, 0.1, 0.9, 0.9, 0.9};
  const fleet::StudySummary summary =
      fleet::summarise(*study.results([&](const fleet::Combination& one) {
        if (one.mission == 6) {
          return ForgedStudy::Forged{.outcome = {}, .error = "no log"};
        }
        return ForgedStudy::with_r2({(one.learner == 0 ? kelpie : small)[one.mission]});
      }));
  ASSERT_EQ(summary.vehicles.size(), 2U);
  const fleet::VehicleSummary& vehicle = summary.vehicles[0];
  EXPECT_EQ(vehicle.missions, 4U);
  EXPECT_NEAR(vehicle.hours, 4.0 * 300.0 / 3600.0, 1e-12);
  const fleet::LearnerSummary& first = vehicle.axes.at(0).learners[0];
  EXPECT_EQ(first.r2_final.runs, 3U);
  EXPECT_EQ(first.r2_final.median, 0.6);
  EXPECT_EQ(first.r2_final.least, 0.3);
  EXPECT_EQ(first.best, 2U);
  EXPECT_EQ(first.least_squares.better, 2U);
  EXPECT_EQ(first.least_squares.worse, 2U);  // without a model, too
  EXPECT_NEAR(first.shortfall.median, 0.005, 1e-12);
  EXPECT_EQ(vehicle.axes[0].learners[1].best, 2U);  // of run 3 least squares is
  EXPECT_EQ(vehicle.axes[0].least_squares.median, 0.5);
  EXPECT_EQ(summary.vehicles[1].failed, 2U);
  EXPECT_EQ(summary.vehicles[1].axes.at(0).learners[1].best, 2U);
  EXPECT_EQ(summary.learners[1].best, 4U);
  EXPECT_EQ(summary.learners[1].judged, 6U);

  ASSERT_EQ(summary.worst.size(), 6U);  // of the first learner
  EXPECT_TRUE(std::isnan(summary.worst[0].r2));
  EXPECT_EQ(summary.worst[1].r2, 0.3);
}

TEST(StudySummary, KeepsTheWorstOfManyAndTheOrderOfMissions) {
  ForgedStudy study;
  study.add_vehicle("one", 700);
  RandomStream random(1, "summary");
  std::vector<double> values;
  for (std::size_t i = 0; i < 700; ++i) {
    values.push_back(random.uniform(0.0, 1.0) - 0.001 * static_cast<double>(i));
  }
  const fleet::StudySummary summary =
      fleet::summarise(*study.results([&](const fleet::Combination& one) {
        return ForgedStudy::with_r2({one.learner == 0 ? values[one.mission] : 0.0});
      }));
  EXPECT_EQ(summary.vehicles[0].axes[0].trend.r2, values);
  EXPECT_TRUE(fleet::stands_out(summary.vehicles[0].axes[0].trend, summary.trends));
  std::ranges::sort(values);
  ASSERT_EQ(summary.worst.size(), fleet::kTuning.worst_runs);
  for (std::size_t i = 0; i < fleet::kTuning.worst_runs; ++i) {
    EXPECT_EQ(summary.worst[i].r2, values[i]);
  }
}

TEST(StudySummary, AnAxisThatSomeLogsHaveAloneIsJudgedOnThese) {
  ForgedStudy study;
  study.add_vehicle("one", 3);
  const fleet::StudySummary summary =
      fleet::summarise(*study.results([&](const fleet::Combination& one) {
        return ForgedStudy::with_r2(one.mission == 1 ? std::vector{0.7, 0.8} : std::vector{0.7});
      }));
  ASSERT_EQ(summary.vehicles[0].axes.size(), 2U);
  EXPECT_EQ(summary.vehicles[0].axes[0].learners[0].r2_final.runs, 3U);
  EXPECT_EQ(summary.vehicles[0].axes[1].learners[0].r2_final.runs, 1U);
  EXPECT_EQ(summary.vehicles[0].axes[1].trend.missions, std::vector<std::size_t>{1});
}

}  // namespace
}  // namespace kelpie::summary_test
