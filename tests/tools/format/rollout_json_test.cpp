// SPDX-License-Identifier: Apache-2.0
#include "format/rollout_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "report/small_rollout.hpp"

namespace kelpie::rollout_json_test {
namespace {

using synthetic::small_rollout;

TEST(RolloutJson, JsonHoldsTheNumbersAndNullsForNone) {
  const auto json = nlohmann::json::parse(format::rollout_json(small_rollout()));
  EXPECT_EQ(json["format"], "kelpie-rollout");
  EXPECT_EQ(json["scores"][1]["name"], "velocity held");
  EXPECT_EQ(json["scores"][0]["horizons"][1]["r2"][0], 0.951);
  EXPECT_TRUE(json["scores"][0]["horizons"][0]["covered"][1].is_null());
  EXPECT_EQ(json["scores"][0]["dead_reckoning"][0]["p95"], 0.111);
}

TEST(RolloutJson, TrajectoryColumnsAreNamedAfterTheStates) {
  const study::OpenLoopResult result = small_rollout();
  study::Trajectory path = result.example;
  const log::Table table = format::trajectory_table(path, result.states);
  EXPECT_EQ(table.names, (std::vector<std::string>{"t_s", "u", "u_spread", "u_measured", "r&d",
                                                   "r&d_spread", "r&d_measured", "beyond"}));
  EXPECT_EQ(table.columns[7], (std::vector<double>{0, 0, 1}));
  path.measured = {{}, {}};
  EXPECT_EQ(format::trajectory_table(path, result.states).names.size(), 6U);
}

}  // namespace
}  // namespace kelpie::rollout_json_test
