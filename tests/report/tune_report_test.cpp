// SPDX-License-Identifier: Apache-2.0
#include "report/tune_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "chart/figure_check.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/small_search.hpp"

namespace kelpie::tune_report_test {
namespace {

using synthetic::small_search;

const study::TuneJournal::Header kHeader{{"dataset", "a\nlog.csv"}, {"seed", "1"}};

TEST(TuneReport, TableHasTableOneBesideOursWithinAHundredColumns) {
  const std::string table = report::tune_table(small_search());
  for (const char* const words :
       {"epsilon", "buffer", "xi", "0.912", "0.881", "least squares  0.701", "paper (Table I)",
        "1 evaluations; given up, since the solver needed too many iterations: 1",
        "tuned       tuned       tuned   paper   paper   paper",
        "udot        vdot        rdot    udot    vdot    rdot",
        "0.1       0.777         0.1    0.01   0.025    0.05",
        "diagonal    diagonal    diagonal    full    full    full"}) {
    EXPECT_NE(table.find(words), std::string::npos) << words << "\n" << table;
  }
  for (const std::string& line : split_text(table, '\n')) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
}

TEST(TuneReport, TunedScoreOfAnUnfinishedSearchIsNotShownBesideThoseOnAllRows) {
  study::TuneResult result = small_search();
  result.rungs.push_back(result.rungs.front());
  EXPECT_EQ(report::tune_table(result).find("0.912"), std::string::npos);
}

TEST(TuneReport, ATableWithoutThePapersAxesStandsAlone) {
  study::TuneResult result = small_search();
  result.references.pop_back();
  EXPECT_EQ(report::tune_table(result).find("Table I"), std::string::npos);
}

TEST(TuneReport, ThePageShowsCandidatesByScoreAndWorkAndTheCheapOne) {
  study::TuneResult result = small_search();
  const auto judged = [](const char* settings, double score, double work) {
    study::ChainScore chain;
    chain.score = score;
    chain.iterations_per_row = work;
    return study::Evaluation{{"udot", 0, settings}, chain};
  };
  result.evaluations.push_back(judged("c=<2>", 0.912, 200.0));
  result.evaluations.push_back(judged("c=3", 0.911, 10.0));
  result.evaluations.push_back(judged("c=4", 0.8, 1.0));
  const std::string page = report::tune_html(result, kHeader);
  EXPECT_EQ(take_apart(page).fault, "");
  EXPECT_NE(
      page.find("best is default with c=&lt;2&gt;, which scores 0.912 with 200.0 iterations of the "
                "solver per row; default with c=3 scores 0.911 with 10.00."),
      std::string::npos);
  const std::vector<FigureRead> figures = figures_in(page);
  ASSERT_EQ(figures.size(), 1U);  // of the other two nothing was judged
  EXPECT_TRUE(figures[0].spec["x"]["log"].get<bool>());
  EXPECT_EQ(figures[0].values("judged on 100 rows").size(), 3U);
  EXPECT_NE(page.find("Given up: 1."), std::string::npos);
}

TEST(TuneReport, NoNameBreaksOutOfTheCommentsOfTheToml) {
  study::TuneResult result = small_search();
  result.interrupted = true;
  const std::string text = report::tuned_toml(result, kHeader);
  EXPECT_NE(text.find("interrupted"), std::string::npos);
  EXPECT_NE(text.find("gamma = [0.1, 0.777, 0.1]"), std::string::npos);
  EXPECT_EQ(text.find("\nlog.csv"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::tune_report_test
