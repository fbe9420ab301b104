// SPDX-License-Identifier: Apache-2.0
#include "report/health_report.hpp"

#include <gtest/gtest.h>

#include <string>

#include "health/card.hpp"

namespace kelpie::health_report_test {
namespace {

// A quantity that rises slowly, with its course found as `kind`.
std::string page_with(health::CourseKind kind, double rise = 0.02) {
  health::HealthTable table;
  table.quantities = {{.name = "surge drag", .unit = ""}};
  for (int day = 0; day < 12; ++day) {
    table.episodes.push_back({.mission = "dive", .name = "dive", .day = static_cast<double>(day)});
    table.estimates.push_back({health::Estimate{1.0 + rise * day, 0.01}});
  }
  health::HealthCard card = health::make_card("boat", false, table, {});
  card.changes.front().course.kind = kind;
  return report::health_html({card});
}

TEST(HealthReport, AnUndecidedChangeIsDrawnNeitherAsADriftNorAsAStep) {
  EXPECT_NE(page_with(health::CourseKind::step).find("course"), std::string::npos);
  EXPECT_NE(page_with(health::CourseKind::drift).find("course"), std::string::npos);
  EXPECT_EQ(page_with(health::CourseKind::undecided).find("course"), std::string::npos);
}

TEST(HealthReport, TheHeadlineIsNotRepeated) {
  const std::string page = page_with(health::CourseKind::drift);
  const std::size_t end = page.find("</h1>");
  const std::string news = page.substr(page.rfind('>', end) + 1, end - page.rfind('>', end) - 1);
  EXPECT_EQ(page.substr(end, page.find("<nav") - end).find(news), std::string::npos) << news;
}

TEST(HealthReport, AFallHasAMinusSign) {
  const std::string page = page_with(health::CourseKind::drift, -0.02);
  const std::size_t title = page.find("<h1");
  EXPECT_NE(page.substr(title, page.find("</h1>") - title).find("surge drag −"), std::string::npos);
}

// What the terminal says of a boat whose drag rises, with a cleaning at this day.
std::string verdict_since(double cleaning) {
  health::HealthTable table;
  table.quantities = {{.name = "surge drag", .unit = ""}};
  for (int day = 0; day < 40; ++day) {
    table.episodes.push_back({.mission = "dive", .name = "dive", .day = static_cast<double>(day)});
    table.estimates.push_back({health::Estimate{1.0 + 0.02 * day, 0.01}});
  }
  return report::health_verdict(
      {health::make_card("boat", false, table, {{"cleaning", cleaning}})});
}

TEST(HealthReport, TheTerminalSaysWhereTooFewEpisodesFollowADay) {
  const std::string untold = "since cleaning: too few episodes to tell a change";
  EXPECT_NE(verdict_since(37.5).find(untold), std::string::npos) << verdict_since(37.5);
  EXPECT_EQ(verdict_since(5.5).find(untold), std::string::npos) << verdict_since(5.5);
}

}  // namespace
}  // namespace kelpie::health_report_test
