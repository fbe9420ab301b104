// SPDX-License-Identifier: Apache-2.0
#include "study/coverage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace kelpie::coverage_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// An interval of −1 … 1; who isn't held is at 2.
void add(study::OneStep& steps, bool held, int configuration, double half = 1.0) {
  steps.time_s.push_back(static_cast<double>(steps.truth.size()));
  steps.configuration.push_back(configuration);
  steps.samples.push_back(steps.truth.size() + 1);
  steps.truth.push_back(held ? 0.0 : 2.0);
  steps.predicted.push_back(0.0);
  steps.lower.push_back(-half);
  steps.upper.push_back(half);
}

TEST(CoverageOf, CountsOnlySamplesThatHadAnInterval) {
  study::OneStep steps;
  for (int i = 0; i < 40; ++i) {
    add(steps, true, 0, kInfinity);
  }
  EXPECT_EQ(study::coverage_of(steps).samples, 0U);
  EXPECT_TRUE(std::isnan(study::coverage_of(steps).share));
  for (int i = 0; i < 10; ++i) {
    add(steps, i % 5 != 0, 0, i < 9 ? 1.0 : 1.5);
  }
  const study::Coverage coverage = study::coverage_of(steps);
  EXPECT_EQ(coverage.samples, 10U);
  EXPECT_DOUBLE_EQ(coverage.share, 0.8);
  EXPECT_DOUBLE_EQ(coverage.median_width, 2.0);
  EXPECT_DOUBLE_EQ(coverage.mean_width, 2.1);
  EXPECT_TRUE(std::isnan(coverage.lowest));
}

// What goes wrong in the first 500 samples of a configuration doesn't count against it; what goes
// wrong after them does, and no window reaches over a switch.
TEST(CoverageOf, TheLowestWindowKeepsToOneConfigurationAndSparesItsStart) {
  study::OneStep steps;
  for (int configuration = 0; configuration < 2; ++configuration) {
    for (int i = 0; i < 1600; ++i) {
      const bool late = configuration == 1 && i >= 1000 && i < 1050;
      add(steps, i >= 500 && !late, configuration);
    }
  }
  const study::Coverage coverage = study::coverage_of(steps);
  EXPECT_DOUBLE_EQ(coverage.lowest, 0.9);
  const std::vector<double> running = study::running_coverage(steps);
  EXPECT_TRUE(std::isnan(running[498]));
  EXPECT_DOUBLE_EQ(running[499], 0.0);
  EXPECT_DOUBLE_EQ(running[1599], 1.0);
  EXPECT_TRUE(std::isnan(running[1600]));
  EXPECT_DOUBLE_EQ(running[1600 + 1049], 0.9);
}

TEST(ErrorsByNovelty, PutsEveryPredictionInItsTenth) {
  const std::array truth{1.0, 1.0, 5.0, 9.0};
  const std::array<Prediction, 4> predicted{
      Prediction{0.0, -2.0, 2.0, 0.0}, {2.0, 1.5, 2.5, 0.09}, {2.0, 0.0, 4.0, 1.0}, {.value = 0.0}};
  const std::vector<study::NoveltyBin> bins = study::errors_by_novelty(truth, predicted);
  ASSERT_EQ(bins.size(), 10U);
  EXPECT_EQ(bins[0].rows, 2U);
  EXPECT_DOUBLE_EQ(bins[0].rms_error, 1.0);
  EXPECT_DOUBLE_EQ(bins[0].held, 0.5);
  EXPECT_EQ(bins[4].rows, 0U);
  EXPECT_TRUE(std::isnan(bins[4].rms_error));
  EXPECT_DOUBLE_EQ(bins[9].rms_error, 3.0);
  EXPECT_TRUE(
      study::errors_by_novelty(std::span(truth).last(1), std::span(predicted).last(1)).empty());
}

}  // namespace
}  // namespace kelpie::coverage_test
