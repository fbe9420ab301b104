// SPDX-License-Identifier: Apache-2.0
#include "lab/reproduction_report.hpp"

#include <gtest/gtest.h>

#include "chart/markup_check.hpp"
#include "chart/wording.hpp"
#include "cli/command.hpp"
#include "core/text.hpp"
#include "lab/claims.hpp"
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

lab::Reproduction real_and_simulated() {
  lab::Reproduction result = synthetic::reproduction();
  result.studies.push_back(synthetic::study({}, "real", study::SplitKind::random));
  result.real_log = true;
  return result;
}

TEST(ReproductionPage, IsSoundAndShowsEveryClaimWithItsRuleAndVerdicts) {
  const file::Json document = lab::reproduction_document(synthetic::reproduction());
  const std::string page = lab::reproduction_html(document);
  expect_sound(page);
  EXPECT_FALSE(document["claims"].empty());
  for (const file::Json& claim : document["claims"]) {
    for (const file::Json& text : {claim["claim"], claim["rule"], claim["paper"]["measured"]}) {
      EXPECT_TRUE(says(page, chart::escape_markup(text.get<std::string>()))) << text;
    }
  }
  for (const char* const text :
       {"Fig. 3", "Fig. 4", "Fig. 5", "Fig. 6", "Table I", "everything below is simulation",
        "100, 40, 20", "off-line baseline", "Command: kelpie-lab reproduce"}) {
    EXPECT_TRUE(says(page, text)) << text;
  }
  EXPECT_FALSE(says(page, "quick version"));
}

TEST(ReproductionPage, SaysWhatTheQuickOneCannotShow) {
  lab::Reproduction result = real_and_simulated();
  result.plan = lab::quick_plan();
  const file::Json document = lab::reproduction_document(result);
  for (const std::string& page :
       {lab::reproduction_html(document), lab::reproduction_markdown(document)}) {
    EXPECT_TRUE(says(page, "quick version: simulated phases at 20 %"));
    EXPECT_TRUE(says(page, "the buffer never fills, so FIFO equals"));
    EXPECT_TRUE(says(page, "exist in simulation alone"));
  }
  EXPECT_TRUE(says(lab::reproduction_table(document), "FIFO equals the paper's learner"));
}

TEST(ReproductionPage, ShowsAnEntryInEveryTableOfRows) {
  lab::Reproduction result = real_and_simulated();
  for (lab::StreamStudy& study : result.studies) {
    lab::RowRuns mine = study.rows.front();
    mine.kind = lab::RowKind::entry;
    mine.key = "entry_mine";
    mine.name = "<mine>";
    study.rows.push_back(mine);
  }
  const std::string page = lab::reproduction_html(lab::reproduction_document(result));
  expect_sound(page);
  // Gains, ends and settings of three studies; two axes of three figures of Fig. 5.
  EXPECT_EQ(occurrences(page, "&lt;mine&gt;"), 13U);
}

TEST(ReproductionDocument, HoldsEveryNumberAndNullForNan) {
  lab::Reproduction result = synthetic::reproduction();
  result.studies[0].rows[0].seeds[0].axes[0].validation[3].r2 = std::nan("");
  result.studies[0].rows[0].seeds[1].axes[0].validation[5].r2 = 0.2;
  result.studies[0].rows[0].seeds[0].axes[0].validation[5].r2 = 0.4;
  const file::Json document = lab::reproduction_document(result);
  EXPECT_EQ(document["format"], "kelpie-reproduction");
  const file::Json& row = document["streams"][0]["rows"][0];
  const file::Json& curve = row["curves"][0];
  EXPECT_EQ(row["samples"].size(), curve["r2"].size());
  EXPECT_EQ(row["samples"][5], 1200);
  EXPECT_TRUE(curve["r2"][3].is_null());
  EXPECT_EQ(curve["low"][5], 0.2);
  EXPECT_EQ(curve["r2"][5], 0.3);
  EXPECT_EQ(curve["high"][5], 0.4);
  EXPECT_EQ(row["ends"].size(), 2U);        // seeds
  EXPECT_EQ(row["ends"][1].size(), 2U);     // configurations
  EXPECT_EQ(row["ends"][1][0].size(), 2U);  // axes
  EXPECT_EQ(document["streams"][0]["offline"][0]["models"][0]["r2"][1], 0.6);
}

// The page of the docs says what its numbers say: whoever changes a rule, a table or a number makes
// both again.
TEST(ReproductionDocument, ThePageOfTheDocsFollowsFromItsNumbers) {
  const std::string folder = KELPIE_SOURCE_DIR "/";
  const file::Json document = file::parse_json(
      testing::content_of(folder + "scripts/site/reproduction.json"), "reproduction.json");
  const std::string made = lab::reproduction_markdown(document);
  const std::string page = testing::content_of(folder + "docs/measured/reproduction.md");
  EXPECT_EQ(page.substr(0, made.size()), made);
  const std::vector<lab::Claim> claims = lab::claims_of(document);
  ASSERT_EQ(document["claims"].size(), claims.size());
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const file::Json& recorded = document["claims"][i];
    EXPECT_EQ(recorded["claim"], claims[i].text);
    EXPECT_EQ(recorded["paper"]["finding"], lab::finding_text(claims[i].paper.finding));
    EXPECT_EQ(recorded["paper"]["measured"], claims[i].paper.measured);
  }
}

TEST(ReproductionTable, IsNarrowEnoughForATerminal) {
  const std::string table =
      lab::reproduction_table(lab::reproduction_document(real_and_simulated()));
  EXPECT_TRUE(says(table, "off-line SVR"));
  for (const std::string& line : split_text(table, '\n')) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
}

}  // namespace
}  // namespace kelpie::reproduction_report_test
