// SPDX-License-Identifier: Apache-2.0
#include "report/comparison_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "chart/markup_check.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/comparison_views.hpp"
#include "report/comparisons.hpp"

namespace kelpie::comparison_report_test {
namespace {

using synthetic::comparison;

const synthetic::Finals kFinals{.kelpie = 0.931, .variant = 0.842, .fit = 0.753};

TEST(ComparisonReport, TheTableHasEveryContenderWithinAHundredColumns) {
  study::Comparison wide = comparison(kFinals, 7);
  wide.contests[1].name = "preset=paper";
  wide.contests.insert(wide.contests.begin() + 1, 2, wide.contests[1]);
  for (study::Contest& contest : wide.contests) {
    contest.stream.axes[0].name = "an axis with a name that is longer than any should be";
  }
  const std::string table = report::comparison_table(wide);
  for (const char* const words : {"0.931", "0.842", "0.753", "least", "last", "Recommendation"}) {
    EXPECT_NE(table.find(words), std::string::npos) << words;
  }
  for (const std::string& line : split_text(table, '\n')) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
}

TEST(ComparisonReport, WhoHasNoSuchFigureHasNoColumn) {
  const study::Comparison one = comparison(kFinals);
  EXPECT_EQ(report::comparison_view(one, report::kHeldOutR2).head,
            (std::vector<std::string>{"axis", "kelpie", "terms=none", "least\nsquares", "mean"}));
  EXPECT_EQ(report::comparison_view(one, report::kOneStepR2).head.back(), "last\nvalue");
}

TEST(ComparisonReport, JsonHoldsEveryFigureAndNullWhereThereIsNone) {
  study::Comparison two = comparison(kFinals, 2);
  two.left_out = {{"preset=paper", "log.csv: u: is constant"}};
  const auto json = nlohmann::json::parse(report::comparison_json(two));
  EXPECT_EQ(json["format"], "kelpie-compare");
  EXPECT_EQ(json["dataset"]["path"], "logs/dive_7.csv");
  EXPECT_EQ(json["contenders"][0]["axes"][1]["r2"]["final"], 0.931);
  EXPECT_EQ(json["contenders"][2]["kind"], "least_squares");
  EXPECT_EQ(json["contenders"][2]["axes"][0]["validation"]["r2"].size(), 8U);
  EXPECT_TRUE(json["contenders"][4]["axes"][0]["r2"]["final"].is_null());
  EXPECT_EQ(json["one_step_samples"], nlohmann::json({300, 300}));
  EXPECT_EQ(json["left_out"]["preset=paper"], "log.csv: u: is constant");
  EXPECT_EQ(json["recommendation"].size(), 3U);  // two axes, the settings
}

TEST(ComparisonReport, ThePageIsSoundAndEscapesWhatTheLogSays) {
  study::Comparison odd = comparison(kFinals, 2);
  for (study::Contest& contest : odd.contests) {
    contest.stream.axes[1].name = "<b>\"&";
  }
  odd.left_out = {{"preset=paper", "<i>"}};
  odd.contests[1].stream.axes[0].r2_final = -1e8;
  odd.contests[2].stream.axes[0].r2_final = synthetic::kNan;
  const std::string page = report::comparison_html(odd);
  EXPECT_EQ(take_apart(page).fault, "");
  // Two figures over all axes and one per axis, each in two sizes.
  EXPECT_EQ(occurrences(page, "<svg"), 2U * (2U + 2U));
  EXPECT_NE(page.find("What lies below −0.2 is drawn on the edge."), std::string::npos);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
}

TEST(ComparisonReport, EveryContenderHasAMarkerInEveryRowOfTheFigure) {
  const chart::Panel panel =
      report::comparison_panel(comparison(kFinals, 3), report::kHeldOutR2, 400);
  const std::vector<Element> markers = of_class(panel.svg, "marker");
  std::size_t drawn = 0;
  for (const Element& marker : markers) {
    drawn += occurrences(marker["d"], "M") == 3 ? 1 : 0;  // the legend's have one
  }
  EXPECT_EQ(drawn, 4U);
  for (const char* const name : {">axis0<", ">axis2<", ">terms=none<", ">mean<"}) {
    EXPECT_NE(panel.svg.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(panel.svg.find(">last value<"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::comparison_report_test
