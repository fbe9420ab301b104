// SPDX-License-Identifier: Apache-2.0
#include "format/tune_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "report/small_search.hpp"

namespace kelpie::tune_json_test {
namespace {

TEST(TuneJson, JsonHoldsEveryEvaluationAndNullForNoScore) {
  const auto json =
      nlohmann::json::parse(format::tune_json(synthetic::small_search(), {{"seed", "1"}}));
  EXPECT_EQ(json["search"]["seed"], "1");
  EXPECT_EQ(json["tuned"]["gamma"], "0.1,0.777,0.1");
  EXPECT_TRUE(json["axes"][0]["references"]["paper"].is_null());
  EXPECT_TRUE(json["evaluations"][0]["given_up"].get<bool>());
  EXPECT_TRUE(json["evaluations"][0]["score"].is_null());
  EXPECT_EQ(json["logs"][0]["rungs"][0]["windows"][0]["judged_from"], 25);
}

TEST(TuneJson, JsonTellsEveryLogsScores) {
  const auto json =
      nlohmann::json::parse(format::tune_json(synthetic::search_of_two_logs(), {{"seed", "1"}}));
  const auto& sway = json["logs"][1]["axes"][1];
  EXPECT_EQ(json["logs"][1]["name"], "other <log>.csv");
  EXPECT_EQ(sway["name"], "vdot");
  EXPECT_EQ(sway["score"], 0.805);
  EXPECT_EQ(sway["base"], 0.9);
  EXPECT_EQ(sway["least_squares"], 0.701);
  EXPECT_TRUE(sway["mean"].is_null());
}

}  // namespace
}  // namespace kelpie::tune_json_test
