// SPDX-License-Identifier: Apache-2.0
#include "report/health_report.hpp"

#include <gtest/gtest.h>

#include <string>

#include "health/card.hpp"

namespace kelpie::health_report_test {
namespace {

// A quantity that rises slowly, with its course found as `kind`.
std::string page_with(health::CourseKind kind) {
  health::HealthTable table;
  table.quantities = {{.name = "surge drag", .unit = ""}};
  for (int day = 0; day < 12; ++day) {
    table.episodes.push_back({.mission = "dive", .name = "dive", .day = static_cast<double>(day)});
    table.estimates.push_back({health::Estimate{1.0 + 0.02 * day, 0.01}});
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

}  // namespace
}  // namespace kelpie::health_report_test
