// SPDX-License-Identifier: Apache-2.0
#include "report/comparison_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "chart/figure_check.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
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
  // Three figures over all axes and one per axis.
  EXPECT_EQ(figures_in(page).size(), 3U + 2U);
  EXPECT_NE(page.find("is in the table alone."), std::string::npos);
  EXPECT_EQ(without_programs(page).find("<b>"), std::string::npos);
}

TEST(ComparisonReport, EveryContenderHasAMarkerAtEveryAxisOfTheFigure) {
  const FigureRead figure =
      figures_in(report::comparison_figure(comparison(kFinals, 3), report::kHeldOutR2)).at(0);
  EXPECT_EQ(figure.spec["x"]["names"], nlohmann::json({"axis0", "axis1", "axis2"}));
  for (const char* const name : {"kelpie", "terms=none", "least squares"}) {
    ASSERT_EQ(figure.values(name).size(), 3U) << name;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::lround(figure.values(name, "x")[axis]), static_cast<long>(axis)) << name;
    }
  }
  EXPECT_TRUE(figure.series("last value").is_null());
  EXPECT_TRUE(figure.series("mean").is_null()) << "far below the others, which it would press";
  EXPECT_GT(figure.spec["y"]["range"][0].get<double>(), 0.5);
}

TEST(ComparisonReport, BeginsWithTheAdviceAndARankedTable) {
  const chart::TextTable ranked =
      report::ranked_view(comparison({.kelpie = 0.6, .variant = 0.7, .fit = 0.65}));
  ASSERT_EQ(ranked.rows.size(), 4U) << "the last value has no R² on held-out rows";
  EXPECT_EQ(ranked.rows[0][0], "terms=none");
  EXPECT_EQ(ranked.rows[1][0], "least squares");
  EXPECT_EQ(ranked.rows[2].back(), "0.100");
  EXPECT_TRUE(ranked.notes[0].starts_with("R² on held-out rows, at the end."));
  const std::string page = report::comparison_html(comparison(kFinals));
  EXPECT_LT(page.find(">No gain: keep the defaults.</h1>"), page.find("<table")) << "one sentence";
}

}  // namespace
}  // namespace kelpie::comparison_report_test
