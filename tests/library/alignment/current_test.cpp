// SPDX-License-Identifier: Apache-2.0
#include "kelpie/alignment/alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "alignment/drifting_log.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::current_test {
namespace {

using Log = testing::DriftingLog;

constexpr double kDegrees = 180.0 / std::numbers::pi;

// Root mean square of the difference to the true current [m/s].
double error_of(const Current& found, const Log& log, const Log::Water& truth) {
  double sum = 0.0;
  for (const double t : log.times) {
    const auto [c1, c2] = found.at(t);
    const auto [true_c1, true_c2] = truth(t);
    sum += (c1 - true_c1) * (c1 - true_c1) + (c2 - true_c2) * (c2 - true_c2);
  }
  return std::sqrt(sum / static_cast<double>(log.times.size()));
}

TEST(Current, AConstantCurrentIsFoundAsOne) {
  const Log log(Log::constant);
  const CurrentResult found = find_current(log.problem(), "psi", log.headings);
  ASSERT_FALSE(found.current.none()) << found.why;
  EXPECT_EQ(found.current.velocity.size(), 1);
  EXPECT_LT(error_of(found.current, log, Log::constant), 0.02);
  EXPECT_GT(found.gain, 0.3);
  EXPECT_EQ(found.current.text(), "a current of 0.29 m/s towards 329° of psi");
}

TEST(Current, ACurrentThatWandersIsFollowed) {
  const Log log(Log::wandering);
  const CurrentResult found = find_current(log.problem(), "psi", log.headings);
  ASSERT_GT(found.current.velocity.size(), 1) << found.why;
  EXPECT_LT(error_of(found.current, log, Log::wandering), 0.03);
  EXPECT_EQ(found.current.targets, (std::array<std::size_t, 2>{0, 1}));
  EXPECT_NE(found.current.text().find("on average"), std::string::npos);
}

TEST(Current, StillWaterStaysStill) {
  const Log log(Log::still);
  const CurrentResult found = find_current(log.problem(), "psi", log.headings);
  EXPECT_TRUE(found.current.none()) << found.current.text();
  EXPECT_NE(found.why.find("no current"), std::string::npos) << found.why;
}

TEST(Current, DegreesAndAHeadingAgainstTheYawRateAreTold) {
  Log log(Log::constant);
  for (double& heading : log.headings) {
    const double turned = std::fmod(-heading * kDegrees, 360.0);
    heading = turned < 0.0 ? turned + 360.0 : turned;
  }
  const CurrentResult found = find_current(log.problem(), "compass", log.headings);
  ASSERT_FALSE(found.current.none()) << found.why;
  EXPECT_NEAR(found.current.unit, -1.0 / kDegrees, 1e-12);
  EXPECT_LT(error_of(found.current, log, Log::constant), 0.02);
  EXPECT_EQ(found.current.text(), "a current of 0.29 m/s towards 31° of compass");
}

TEST(Current, TheBodysShareIsThatOfTheEquations) {
  const Log log(Log::wandering, 200);
  Current current{.heading = "psi", .times_s = log.times, .velocity = {}};
  std::ranges::transform(log.times, std::back_inserter(current.velocity), Log::wandering);
  for (std::size_t row = 0; row < log.times.size(); ++row) {
    const auto [ahead, aside] = current.in_body(log.headings[row], log.times[row]);
    EXPECT_NEAR(log.inputs[5 * row] - ahead, log.through_water[5 * row], 1e-12);
    EXPECT_NEAR(log.inputs[5 * row + 1] - aside, log.through_water[5 * row + 1], 1e-12);
  }
  EXPECT_EQ(current.at(-1.0), current.velocity.front());
  EXPECT_EQ(current.at(1e9), current.velocity.back());
}

TEST(Current, WhatTellsNoCurrentIsSaid) {
  Log log(Log::constant, 1500);
  const auto why = [&](const AlignmentProblem& problem) {
    const CurrentResult found = find_current(problem, "psi", log.headings);
    EXPECT_TRUE(found.current.none());
    EXPECT_EQ(found.gain, 0.0);
    return found.why;
  };
  AlignmentProblem problem = log.problem();
  problem.input_names = {"a", "b", "c", "n", "m"};
  EXPECT_NE(why(problem).find("not known by name"), std::string::npos);
  problem = log.problem();
  problem.rows = problem.rows.first(100);
  EXPECT_NE(why(problem).find("too few"), std::string::npos);
  log.headings[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(why(log.problem()).find("not known in every row"), std::string::npos);
  std::ranges::fill(log.headings, 1.0);
  EXPECT_EQ(why(log.problem()), "psi does not turn as the yaw rate tells");
  for (std::size_t row = 0; row < log.times.size(); ++row) {
    log.inputs[5 * row + 2] *= kDegrees;
  }
  EXPECT_EQ(why(log.problem()), "the yaw rate is not in rad/s");
}

TEST(Current, BadNumbersAreRefused) {
  const Current good{.heading = "psi", .times_s = {0.0, 1.0}, .velocity = {{0.1, 0.0}, {0.2, 0.0}}};
  EXPECT_NO_THROW(good.validate());
  Current bad = good;
  bad.times_s = {1.0, 1.0};
  EXPECT_THROW(bad.validate(), InputError);
  bad = good;
  bad.velocity.pop_back();
  EXPECT_THROW(bad.validate(), InputError);
  bad = good;
  bad.velocity[0][1] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(bad.validate(), InputError);
  bad = good;
  bad.unit = 0.0;
  EXPECT_THROW(bad.validate(), InputError);
}

}  // namespace
}  // namespace kelpie::current_test
