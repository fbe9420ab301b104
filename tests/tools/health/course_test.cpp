// SPDX-License-Identifier: Apache-2.0
#include "health/course.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/quantile.hpp"
#include "health/card.hpp"
#include "health/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::course_test {
namespace {

using health::Course;
using health::CourseKind;
using health::Series;

constexpr double kError = 0.004;

// One value a week around `truth`.
Series weekly(std::size_t weeks, RandomStream& random, const std::function<double(double)>& truth) {
  Series series;
  for (std::size_t week = 0; week < weeks; ++week) {
    const double day = 7.0 * static_cast<double>(week);
    series.days.push_back(day);
    series.estimates.push_back({truth(day) + kError * random.normal(), kError});
  }
  return series;
}

double fouling(double day) {
  return 1.0 + 0.01 * std::max(0.0, day - 56.0) / 7.0;
}

TEST(Course, NoiseHasNoChangeInAYearOfWeeklyTests) {
  RandomStream random(1, "course");
  int reports = 0;
  for (int vehicle = 0; vehicle < 300; ++vehicle) {
    const Series year = weekly(52, random, [](double) { return 1.0; });
    bool found = false;
    for (std::size_t week = 1; week <= 52; ++week) {
      Series part;
      part.days.assign(year.days.begin(), year.days.begin() + static_cast<std::ptrdiff_t>(week));
      part.estimates.assign(year.estimates.begin(),
                            year.estimates.begin() + static_cast<std::ptrdiff_t>(week));
      found |= health::is_found(health::judge(part));
    }
    reports += found ? 1 : 0;
  }
  EXPECT_LE(reports, 3);
}

TEST(Course, ADriftIsToldFromAStepWithSizeRateAndBeginning) {
  RandomStream random(2, "course");
  int inside = 0;
  for (int vehicle = 0; vehicle < 50; ++vehicle) {
    const Course drift = health::judge(weekly(20, random, fouling));
    EXPECT_EQ(drift.kind, CourseKind::drift);
    EXPECT_LE(drift.since_low, 63.0);
    EXPECT_GE(drift.since_high, 42.0);
    EXPECT_NEAR(drift.rate.value, 0.01 / 7.0, 4.0 * drift.rate.error);
    inside += std::abs(drift.change.value - 0.11) < kNormal90 * drift.change.error ? 1 : 0;
    const Course step =
        health::judge(weekly(20, random, [](double day) { return day > 60.0 ? 1.05 : 1.0; }));
    EXPECT_EQ(step.kind, CourseKind::step);
    EXPECT_EQ(step.since_day, 63.0);
    EXPECT_LT(step.margin, 0.0);
  }
  EXPECT_GE(inside, 40);
}

// Scatter beyond the told errors and neighbours that go together are no evidence.
TEST(Course, ErrorsToldTooSmallAreSeenFromTheScatter) {
  RandomStream random(3, "course");
  int reports = 0;
  for (int vehicle = 0; vehicle < 100; ++vehicle) {
    Series series = weekly(40, random, [](double) { return 1.0; });
    double slow = 0.0;
    for (health::Estimate& estimate : series.estimates) {
      slow = 0.6 * slow + 0.8 * random.normal();
      estimate = {1.0 + kError * slow, kError / 2.0};
    }
    reports += health::is_found(health::judge(series)) ? 1 : 0;
  }
  EXPECT_LE(reports, 5);
}

TEST(Course, FewEpisodesAreNotJudged) {
  RandomStream random(4, "course");
  const Series few =
      weekly(health::kTuning.fewest_episodes - 1, random, [](double day) { return day; });
  EXPECT_EQ(health::judge(few).kind, CourseKind::unknown);
  EXPECT_EQ(health::judge({}).kind, CourseKind::unknown);
  const Series same{.days = std::vector<double>(9, 3.0),
                    .estimates = std::vector<health::Estimate>(9, {1.0, 0.1})};
  EXPECT_EQ(health::judge(same).kind, CourseKind::unknown);
}

TEST(HealthCard, CountsFromTheCleaningAndSaysDateAndRate) {
  RandomStream random(5, "course");
  health::HealthTable table{
      .quantities = {{"surge drag", ""}, {"surge force", "m/s²"}}, .episodes = {}, .estimates = {}};
  const double start = health::day_of("2026-01-05", "day");
  for (int week = 19; week >= 0; --week) {  // in no order
    const double day = 7.0 * week;
    table.episodes.push_back({.mission = "m", .name = "m", .day = start + day, .hours = 1.0});
    table.estimates.push_back(
        {{fouling(day) + kError * random.normal(), kError}, {0.01 * random.normal(), 0.01}});
  }
  const health::HealthCard card =
      health::make_card("auv", true, table, {{"cleaning", start + 60.0}});
  ASSERT_EQ(card.changes.size(), 4U);
  const std::string text = health::change_text(card, card.changes[0]);
  EXPECT_TRUE(text.starts_with("surge drag +1")) << text;
  EXPECT_NE(text.find(" 2026, 0.1"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with(" % a day")) << text;
  EXPECT_EQ(card.changes[1].course.kind, CourseKind::drift);
  EXPECT_GE(card.changes[1].course.since_day, start + 60.0);
  EXPECT_EQ(card.changes[2].course.kind, CourseKind::constant);
}

TEST(HealthCard, ReadsDates) {
  EXPECT_EQ(health::day_of("1970-01-02", "day"), 1.0);
  EXPECT_EQ(health::day_of("1970-01-02T12:00", "day"), 1.5);
  for (const char* const date : {"", "2026-13-01", "2026-02-30", "3 March", "2026-1-1"}) {
    EXPECT_THROW(health::day_of(date, "day"), InputError) << date;
  }
  EXPECT_EQ(health::day_in_name("dive_19700103_1200.csv"), 2.5);
  EXPECT_EQ(health::day_in_name("1970-01-03.csv"), 2.0);
  EXPECT_TRUE(std::isnan(health::day_in_name("sea035_10.csv")));
  EXPECT_TRUE(std::isnan(health::day_in_name("19709999.csv")));
}

// A thruster that was dead, and is repaired.
TEST(HealthCard, ARatioToNothingIsToldOfTheNominal) {
  RandomStream random(6, "course");
  health::HealthTable table{.quantities = {{"th1 gain", ""}}, .episodes = {}, .estimates = {}};
  for (int week = 0; week < 20; ++week) {
    table.episodes.push_back({.mission = "m", .name = "m", .day = 7.0 * week, .hours = 1.0});
    table.estimates.push_back({{(week < 10 ? -0.002 : 0.8) + 0.01 * random.normal(), 0.01}});
  }
  table.estimates[15][0].error = std::numeric_limits<double>::infinity();  // tells nothing
  const health::HealthCard card = health::make_card("auv", true, table, {});
  ASSERT_EQ(card.changes[0].course.kind, CourseKind::step);
  EXPECT_TRUE(health::change_text(card, card.changes[0]).starts_with("th1 gain +80"))
      << health::change_text(card, card.changes[0]);
}

}  // namespace
}  // namespace kelpie::course_test
