// SPDX-License-Identifier: Apache-2.0
#include "report/rollout_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "chart/markup_check.hpp"

namespace kelpie::rollout_report_test {
namespace {

study::OpenLoopResult small_result() {
  study::OpenLoopResult result;
  result.source = "<log>.csv";
  result.model = "model.json";
  result.split = "held out: all";
  result.rows = 1234;
  result.stretches = 2;
  result.fade_s = 3.0;
  result.states = {"u", "r&d"};
  result.units = {"m/s", ""};
  for (const char* const name : {"kelpie", "velocity held"}) {
    study::OpenLoopScore& score = result.scores.emplace_back();
    score.name = name;
    for (const double seconds : {1.0, 10.0}) {
      score.horizons.push_back({seconds, 40, {0.951, -3.0}, {0.01, 0.02}, {0.9, NAN}, 0.25});
    }
    score.reckoning = {{10.0, 12, 0.05, 0.111}};
  }
  result.example.states = {0, 1};
  result.example.time_s = {0.0, 0.5, 1.0};
  result.example.measured = {{1, 2, 3}, {1, 1, 1}};
  result.example.velocity = {{1, 2.1, 3.2}, {1, 1.1, 1.2}};
  result.example.spread = {{0, 0.1, 0.2}, {0, 0.1, 0.2}};
  result.example.beyond = {false, false, true};
  return result;
}

TEST(RolloutReport, TableShowsEveryModelAtEveryHorizon) {
  const std::string table = report::rollout_table(small_result());
  for (const char* const words :
       {"1,234 rows (held out: all) in 2 unbroken stretches", "velocity held", "0.951 / −3.000",
        "0.900 / –", "0.050 (0.111)", "commands go along a line"}) {
    EXPECT_NE(table.find(words), std::string::npos) << words << "\n" << table;
  }
}

TEST(RolloutReport, JsonHoldsTheNumbersAndNullsForNone) {
  const auto json = nlohmann::json::parse(report::rollout_json(small_result()));
  EXPECT_EQ(json["format"], "kelpie-rollout");
  EXPECT_EQ(json["scores"][1]["name"], "velocity held");
  EXPECT_EQ(json["scores"][0]["horizons"][1]["r2"][0], 0.951);
  EXPECT_TRUE(json["scores"][0]["horizons"][0]["covered"][1].is_null());
  EXPECT_EQ(json["scores"][0]["dead_reckoning"][0]["p95"], 0.111);
}

TEST(RolloutReport, PageIsSoundMarkupAndEscapesNames) {
  const std::string page = report::rollout_html(small_result());
  EXPECT_EQ(take_apart(page).fault, "");
  EXPECT_EQ(page.find("<log>"), std::string::npos);
  EXPECT_NE(page.find("What lies below 0.5 is in the table alone."), std::string::npos);
  EXPECT_NE(page.find("u in m/s"), std::string::npos);
}

TEST(RolloutReport, TrajectoryColumnsAreNamedAfterTheStates) {
  const study::OpenLoopResult result = small_result();
  study::Trajectory path = result.example;
  const log::Table table = report::trajectory_table(path, result.states);
  EXPECT_EQ(table.names, (std::vector<std::string>{"t_s", "u", "u_spread", "u_measured", "r&d",
                                                   "r&d_spread", "r&d_measured", "beyond"}));
  EXPECT_EQ(table.columns[7], (std::vector<double>{0, 0, 1}));
  path.measured = {{}, {}};
  EXPECT_EQ(report::trajectory_table(path, result.states).names.size(), 6U);
}

}  // namespace
}  // namespace kelpie::rollout_report_test
