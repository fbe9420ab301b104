// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "chart/markup_check.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "lab/claims.hpp"
#include "lab/reproduction_views.hpp"
#include "lab/synthetic_reproduction.hpp"

namespace kelpie::reproduction_report_test {
namespace {

bool says(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

void expect_sound(const std::string& page) {
  EXPECT_EQ(take_apart(page).fault, "");
  for (const std::string part : {"http://", "https://", "url(", "<link", "<img", "nan"}) {
    EXPECT_FALSE(says(without_programs(page), part)) << part;
  }
}

TEST(ReproductionPage, IsSoundAndShowsEveryClaimWithItsRuleAndVerdict) {
  const lab::Reproduction result = synthetic::reproduction();
  const std::string page = lab::reproduction_html(result);
  expect_sound(page);
  const std::vector<lab::Claim> claims = lab::claims_of(result);
  EXPECT_FALSE(claims.empty());
  for (const lab::Claim& claim : claims) {
    EXPECT_TRUE(says(page, chart::escape_markup(claim.paper))) << claim.paper;
    EXPECT_TRUE(says(page, chart::escape_markup(claim.rule))) << claim.rule;
    EXPECT_TRUE(says(page, chart::escape_markup(claim.measured))) << claim.measured;
  }
  EXPECT_EQ(occurrences(page, ">holds<"), claims.size());
  for (const char* const text :
       {"random 20 %", "blocks of 400 rows", "Simulation", "everything below is simulation",
        "100, 40, 20", "off-line baseline", "Skipped", "Not measured"}) {
    EXPECT_TRUE(says(page, text)) << text;
  }
  EXPECT_FALSE(says(page, "quick version"));
}

TEST(ReproductionPage, SaysThatItIsTheQuickOneAndWhatThatMeans) {
  lab::Reproduction result = synthetic::reproduction();
  result.plan = lab::quick_plan();
  result.real_log = true;
  const std::string page = lab::reproduction_html(result);
  expect_sound(page);
  EXPECT_TRUE(says(page, "quick version: simulated phases at 20 %"));
  EXPECT_TRUE(says(page, "only the first is public"));
}

TEST(ReproductionPage, HoldsOpponentsBesideOurs) {
  lab::Reproduction result = synthetic::reproduction();
  result.published = {
      {.name = "kelpie", .settings = "gamma=0.1", .steps = {1, 2}, .r2 = {0.5, 0.7}, .mean = 0.6}};
  result.peers = {{.stream = "unmodelled", .learner = "<proposed>", .r2 = {0.1, 0.2, 0.3, 0.4}}};
  const std::string page = lab::reproduction_html(result);
  expect_sound(page);
  for (const char* const text : {"published: greedy", "0.632", "&lt;proposed&gt;"}) {
    EXPECT_TRUE(says(page, text)) << text;
  }
}

TEST(ReproductionJson, HoldsEveryNumberAndNullForNan) {
  lab::Reproduction result = synthetic::reproduction();
  result.studies[0].contenders[0].seeds[0][0].validation[3].r2 = std::nan("");
  const auto json = nlohmann::json::parse(lab::reproduction_json(result));
  EXPECT_EQ(json["format"], "kelpie-reproduction");
  const auto& axis = json["streams"][0]["contenders"][0]["seeds"][0][0];
  EXPECT_EQ(axis["samples"].size(), axis["validation_r2"].size());
  EXPECT_TRUE(axis["validation_r2"][3].is_null());
  EXPECT_EQ(axis["stages"].size(), 2U);
  EXPECT_EQ(json["claims"].size(), lab::claims_of(result).size());
  EXPECT_EQ(json["streams"][0]["offline"][0]["models"][0]["r2"][1], 0.6);
}

TEST(ReproductionTable, IsNarrowEnoughForATerminal) {
  const std::string table = lab::reproduction_table(synthetic::reproduction());
  EXPECT_TRUE(says(table, "off-line baseline"));
  EXPECT_TRUE(says(table, "claims of the paper"));
  for (const std::string& line : split_text(table, '\n')) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
}

TEST(ReproductionViews, TheBandSpansAllSeeds) {
  lab::Reproduction result = synthetic::reproduction();
  lab::ContenderRuns& runs = result.studies[0].contenders[0];
  runs.seeds[0][0].validation[5].r2 = 0.2;
  runs.seeds[1][0].validation[5].r2 = 0.4;
  const lab::MeanCurve curve = lab::mean_curve(runs, 0);
  EXPECT_EQ(curve.low[5].y, 0.2);
  EXPECT_EQ(curve.high[5].y, 0.4);
  EXPECT_NEAR(curve.mean[5].y, 0.3, 1e-12);
  EXPECT_EQ(curve.mean[5].x, 1200.0);
}

}  // namespace
}  // namespace kelpie::reproduction_report_test
