// SPDX-License-Identifier: Apache-2.0
#include "report/tune_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "chart/figure_check.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "report/small_search.hpp"
#include "report/verdicts.hpp"

namespace kelpie::tune_report_test {
namespace {

using synthetic::small_search;

const study::TuneJournal::Header kHeader{{"dataset", "a\nlog.csv"}, {"seed", "1"}};

TEST(TuneReport, TableHasTableOneBesideOursWithinAHundredColumns) {
  const std::string table = report::tune_table(small_search());
  for (const char* const words :
       {"epsilon", "buffer", "xi", "0.912", "0.881", "least squares  0.701", "paper (Table I)",
        "1 evaluations; given up, since the solver needed too many iterations: 1",
        "tuned      tuned      tuned   paper   paper   paper",
        "udot       vdot       rdot    udot    vdot    rdot",
        "0.1      0.777        0.1    0.01   0.025    0.05",
        "diagonal   diagonal   diagonal    full    full    full"}) {
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
  for (study::TunedAxis& axis : result.axes) {
    axis.all.references.pop_back();
  }
  EXPECT_EQ(report::tune_table(result).find("Table I"), std::string::npos);
}

TEST(TuneReport, ThePageShowsCandidatesByScoreAndWorkAndTheCheapOne) {
  study::TuneResult result = small_search();
  const auto judged = [](const char* settings, double score, double work) {
    return study::TrialResult{"udot", 0, settings, score, work};
  };
  result.trials.push_back(judged("c=<2>", 0.912, 200.0));
  result.trials.push_back(judged("c=3", 0.911, 10.0));
  result.trials.push_back(judged("c=4", 0.8, 1.0));
  const std::string page = report::tune_html(result, kHeader);
  EXPECT_EQ(take_apart(page).fault, "");
  EXPECT_NE(page.find("default with c=3 scores 0.911 with 10.00 iterations of the solver per row; "
                      "the best, 0.912 with 200.0."),
            std::string::npos);
  const std::vector<FigureRead> figures = figures_in(page);
  ASSERT_EQ(figures.size(), 1U);  // of the other two nothing was judged
  EXPECT_NEAR(figures[0].spec["y"]["range"][0].get<double>(), 0.807, 1e-9)
      << "the range that counts";
  EXPECT_TRUE(figures[0].spec["x"]["log"].get<bool>());
  EXPECT_EQ(figures[0].values("judged on 100 rows").size(), 3U);
  EXPECT_NE(page.find("Given up in all rounds: 1."), std::string::npos);
}

TEST(TuneReport, ThePageBeginsWithTheGain) {
  study::TuneResult result = small_search();
  for (study::TunedAxis& axis : result.axes) {
    axis.all.tuned = axis.all.base;
  }
  const std::string none = report::tune_html(result, kHeader);
  EXPECT_LT(none.find("No gain: keep the defaults."), none.find("<table"));
  EXPECT_EQ(none.find("--config tuned.toml"), std::string::npos);
  result.axes[1].all.tuned = result.axes[1].all.base + 0.006;  // as the verdict has it
  EXPECT_NE(report::tune_html(result, kHeader).find("score higher: vdot by 0.006."),
            std::string::npos);
  EXPECT_NE(report::tune_verdict(result).find("score higher: vdot by 0.006"), std::string::npos);
  result.axes[1].all.tuned = 0.95;
  const std::string some = report::tune_html(result, kHeader);
  EXPECT_LT(some.find("Tuned settings score higher: vdot by 0.050."), some.find("<table"));
  EXPECT_NE(some.find("--config tuned.toml"), std::string::npos);
  EXPECT_NE(some.find("1 less the mean squared error"), std::string::npos) << "the score defined";
  EXPECT_EQ(some.find("a preset scores higher"), std::string::npos);
  for (study::TunedAxis& axis : result.axes) {
    axis.all.references[0] = 0.97;
  }
  EXPECT_NE(report::tune_html(result, kHeader)
                .find("a preset scores higher than the tuned settings: "
                      "default."),
            std::string::npos);
  result.axes[0].all.tuned = result.axes[1].all.tuned = result.axes[2].all.tuned = NAN;
  EXPECT_NE(report::tune_html(result, kHeader).find("ended before any settings"),
            std::string::npos);
}

TEST(TuneReport, WhereALogIsWorseOffItIsSaidEverywhere) {
  const study::TuneResult result = synthetic::search_of_two_logs();
  EXPECT_EQ(report::worse_text(result),
            "WORSE than the settings the search started from on 1 of 2 logs; most on other "
            "<log>.csv, vdot: 0.805 instead of 0.900");
  const std::string page = report::tune_html(result, kHeader);
  EXPECT_EQ(take_apart(page).fault, "");
  EXPECT_NE(page.find("WORSE than the settings"), std::string::npos);
  EXPECT_NE(report::tuned_toml(result, kHeader).find("# WORSE than"), std::string::npos);
  const std::string table = report::tune_table(result);
  EXPECT_LT(table.find("other <log>.csv  vdot"), table.find("log.csv          udot")) << table;
  EXPECT_NE(table.find("mean score"), std::string::npos);

  study::TuneResult even = result;
  even.axes[1].logs[1].tuned = 0.8999;
  EXPECT_EQ(report::worse_text(even), "") << "no difference that is shown";
  EXPECT_EQ(report::worse_text(small_search()), "");
}

TEST(TuneReport, LogsInTheSameFoldersAreToldApart) {
  study::TuneResult result = synthetic::search_of_two_logs();
  const std::string folders = "/home/somebody/vehicles/auv/of_this_year/";
  result.logs[0].name = folders + "april/dive_1.csv";
  result.logs[1].name = folders + "august/dive_1.csv";
  const std::string table = report::tune_table(result);
  EXPECT_NE(table.find("  april/dive_1.csv "), std::string::npos) << table;
  EXPECT_NE(table.find("  august/dive_1.csv "), std::string::npos) << table;
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
