// SPDX-License-Identifier: Apache-2.0
#include "report/study_report.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "chart/figure_check.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "fleet/forged_study.hpp"
#include "report/tuning.hpp"
#include "report/verdicts.hpp"

namespace kelpie::study_report_test {
namespace {

using testing::ForgedStudy;

// Vehicles whose R² falls from mission to mission, with three axes.
ForgedStudy::Forged falling(const fleet::Combination& one) {
  ForgedStudy::Forged forged = ForgedStudy::with_r2(
      {0.9 - 0.01 * static_cast<double>(one.mission % 40), 0.8, one.learner == 0 ? 0.4 : -0.5});
  forged.outcome.findings = {"since 50.0 s: th2 gives 48 % of its thrust"};
  return forged;
}

struct Pages {
  std::string table;
  std::string page;
  std::string verdict;
};

Pages pages_of(const ForgedStudy& study, const ForgedStudy::Forge& forge) {
  const auto kept = study.results(forge);
  const fleet::Results& results = *kept;
  const fleet::StudySummary summary = fleet::summarise(results);
  const report::StudyView view{results, summary};
  return {report::study_table(view), report::study_html(view), report::study_verdict(view)};
}

TEST(StudyReport, SaysWhoIsBestAndWhatFallsAndFits) {
  ForgedStudy study;
  study.add_vehicle("an autonomous vehicle with a name that is longer than any should be", 20);
  study.add_vehicle("two", 5);
  const Pages pages = pages_of(study, falling);
  EXPECT_NE(pages.table.find("25 missions of 2 vehicles"), std::string::npos) << pages.table;
  EXPECT_NE(pages.table.find("kelpie: within 0.01 of the best R² on held-out rows in 67 %"),
            std::string::npos)
      << pages.table;
  for (const std::string& line : split_text(pages.table, '\n')) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
  EXPECT_EQ(take_apart(pages.page).fault, "");
  EXPECT_EQ(figures_in(pages.page).size(), 3U + 1U);  // one per axis, one of a trend
  EXPECT_NE(pages.page.find("falls"), std::string::npos);
  EXPECT_NE(pages.page.find("th2 gives 48 %"), std::string::npos);
  EXPECT_LT(pages.page.find("Changes were found on an autonomous"), pages.page.find("<table"));
  EXPECT_LT(pages.page.find("<td class=\"left\">since 50.0 s: th2 gives"), pages.page.find("<nav"));
}

TEST(StudyReport, WhatIsLeftAtTheEndStandsBesideTheLastFinding) {
  ForgedStudy study;
  study.add_vehicle("one", 3);
  const Pages pages = pages_of(study, [](const fleet::Combination& one) {
    ForgedStudy::Forged forged = falling(one);
    forged.outcome.left = "th2 gives 48 % of its thrust: udot 0.8";
    return forged;
  });
  EXPECT_LT(pages.page.find("<td class=\"left\">since 50.0 s: th2 gives"), pages.page.find("<nav"));
  EXPECT_GT(pages.page.find("<td class=\"left\">th2 gives 48 % of its thrust: udot 0.8"),
            pages.page.find("<nav"));
}

TEST(StudyReport, TheVerdictCountsAllFindingsOfALongStudy) {
  constexpr std::size_t kMissions = 200;
  ForgedStudy study;
  study.add_vehicle("one", kMissions);
  const Pages pages = pages_of(study, [](const fleet::Combination& one) {
    ForgedStudy::Forged forged = falling(one);
    forged.outcome.left = "no thruster is known to have changed";  // no finding
    return forged;
  });
  EXPECT_NE(pages.verdict.find(
                fmt::format("and {} more findings", kMissions - report::kTuning.most_changes)),
            std::string::npos)
      << pages.verdict;
}

TEST(StudyReport, ItsFiguresShowTheMedians) {
  ForgedStudy study;
  study.add_vehicle("one", 3);
  study.add_vehicle("two", 3);
  const auto kept = study.results([](const fleet::Combination& one) {
    return ForgedStudy::with_r2({one.learner == 0 ? 0.1 * static_cast<double>(one.mission) : -9.0});
  });
  const fleet::Results& results = *kept;
  const fleet::StudySummary summary = fleet::summarise(results);
  const FigureRead figure = figures_in(report::vehicle_figures({results, summary}).at(0)).at(0);
  EXPECT_EQ(figure.spec["x"]["names"], nlohmann::json({"one", "two"}));
  ASSERT_EQ(figure.values("kelpie").size(), 2U);
  EXPECT_NEAR(figure.values("kelpie")[0], 0.1, 1e-4);
  EXPECT_NEAR(figure.values("kelpie")[1], 0.4, 1e-4);
  EXPECT_NEAR(figure.values("small")[0], -0.2, 1e-4);  // drawn where the figure ends
  EXPECT_NEAR(figure.values("least squares")[0], 0.5, 1e-4);
}

TEST(StudyReport, ThePageDoesNotGrowWithTheMissions) {
  const auto size = [](std::size_t missions) {
    ForgedStudy study;
    study.add_vehicle("one", missions);
    return pages_of(study, falling).page.size();
  };
  const std::size_t small = size(200);
  EXPECT_LT(size(1000), small + std::size_t{800} * 10);  // points of trends: some bytes a mission
}

TEST(StudyReport, EscapesWhatLogsAndLearnersAreCalled) {
  ForgedStudy study;
  study.plan.learners[0].name = "<b>";
  study.plan.name = "<i>";
  study.add_vehicle("<u>", 12);
  const Pages pages = pages_of(study, [](const fleet::Combination& one) {
    if (one.mission == 3) {
      return ForgedStudy::Forged{.outcome = {}, .error = "<script>\x1b"};
    }
    ForgedStudy::Forged forged = falling(one);
    forged.outcome.axes[0].name = "<q>";
    forged.outcome.findings = {"<s>"};
    return forged;
  });
  EXPECT_EQ(take_apart(pages.page).fault, "");
  const std::string shown = without_programs(pages.page);
  for (const char* const tag : {"<b>", "<i>", "<u>", "<q>", "<s>", "<script>\x1b"}) {
    EXPECT_EQ(shown.find(tag), std::string::npos) << tag;
  }
  EXPECT_EQ(pages.table.find('\x1b'), std::string::npos);
}

TEST(StudyReport, WithoutAnyResultItListsTheFailures) {
  ForgedStudy study;
  study.add_vehicle("one", 2);
  const Pages pages = pages_of(study, [](const fleet::Combination&) {
    return ForgedStudy::Forged{.outcome = {}, .error = "cannot be read"};
  });
  EXPECT_EQ(take_apart(pages.page).fault, "");
  EXPECT_NE(pages.page.find("of which 4 failed"), std::string::npos);
  EXPECT_NE(pages.page.find("No change was found on 1 vehicle."), std::string::npos);
  EXPECT_NE(pages.table.find("cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::study_report_test
