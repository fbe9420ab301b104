// SPDX-License-Identifier: Apache-2.0
#include "report/rollout_report.hpp"

#include <gtest/gtest.h>

#include "chart/markup_check.hpp"
#include "report/small_rollout.hpp"

namespace kelpie::rollout_report_test {
namespace {

using synthetic::small_rollout;

TEST(RolloutReport, TableShowsEveryModelAtEveryHorizon) {
  const std::string table = report::rollout_table(small_rollout());
  for (const char* const words :
       {"1,234 rows (held out: all) in 2 unbroken stretches", "velocity held", "R² of u", "−3.000",
        "0.900", "0.050 (0.111)", "commands go along a line"}) {
    EXPECT_NE(table.find(words), std::string::npos) << words << "\n" << table;
  }
}

TEST(RolloutReport, PageIsSoundMarkupAndEscapesNames) {
  const std::string page = report::rollout_html(small_rollout());
  EXPECT_EQ(take_apart(page).fault, "");
  EXPECT_EQ(page.find("<log>"), std::string::npos);
  EXPECT_NE(page.find("What lies below 0.5 is in the table alone."), std::string::npos);
  EXPECT_NE(page.find("u in m/s"), std::string::npos);
  EXPECT_NE(page.find("After 10 s surge is within 0.01 m/s and r&amp;d 0.02."), std::string::npos);
}

TEST(RolloutReport, SaysWhoIsCloserAndWhereNoStretchIsLongEnough) {
  study::OpenLoopResult result = small_rollout();
  EXPECT_EQ(report::rollout_html(result).find("Closer in every velocity"), std::string::npos);
  result.scores[1].horizons[1].rms = {0.005, 0.01};
  EXPECT_NE(report::rollout_html(result).find("Closer in every velocity: velocity held."),
            std::string::npos);
  for (study::HorizonScore& horizon : result.scores.front().horizons) {
    horizon.starts = 0;
  }
  EXPECT_NE(report::rollout_html(result).find("No unbroken stretch of rows is as long as 1 s"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::rollout_report_test
