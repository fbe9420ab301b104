// SPDX-License-Identifier: Apache-2.0
#include "format/comparison_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "report/comparisons.hpp"

namespace kelpie::comparison_json_test {
namespace {

TEST(ComparisonJson, JsonHoldsEveryFigureAndNullWhereThereIsNone) {
  study::Comparison two =
      synthetic::comparison({.kelpie = 0.931, .variant = 0.842, .fit = 0.753}, 2);
  two.left_out = {{"preset=paper", "log.csv: u: is constant"}};
  const auto json = nlohmann::json::parse(format::comparison_json(two, {"one", "two"}));
  EXPECT_EQ(json["format"], "kelpie-compare");
  EXPECT_EQ(json["dataset"]["path"], "logs/dive_7.csv");
  EXPECT_EQ(json["contenders"][0]["axes"][1]["r2"]["final"], 0.931);
  EXPECT_EQ(json["contenders"][2]["kind"], "least_squares");
  EXPECT_EQ(json["contenders"][2]["axes"][0]["validation"]["r2"].size(), 8U);
  EXPECT_TRUE(json["contenders"][4]["axes"][0]["r2"]["final"].is_null());
  EXPECT_EQ(json["one_step_samples"], nlohmann::json({300, 300}));
  EXPECT_EQ(json["left_out"]["preset=paper"], "log.csv: u: is constant");
  EXPECT_EQ(json["recommendation"], nlohmann::json({"one", "two"}));
}

}  // namespace
}  // namespace kelpie::comparison_json_test
