// SPDX-License-Identifier: Apache-2.0
#include "report/html.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "chart/figure_check.hpp"
#include "chart/page_assets.hpp"
#include "chart/wording.hpp"
#include "report/synthetic.hpp"
#include "study/summary.hpp"

namespace kelpie::html_test {
namespace {

// What every page must be, whatever the result.
void expect_sound(const std::string& page, const std::string& what) {
  const Markup markup = take_apart(page);
  EXPECT_EQ(markup.fault, "") << what;
  EXPECT_GT(markup.elements.size(), 10U) << what;
  const std::string text = without_programs(page);
  for (const std::string part : {"http://", "https://", " src=", "url(", "<link", "<img"}) {
    EXPECT_EQ(text.find(part), std::string::npos) << what << ": " << part;
  }
  EXPECT_EQ(occurrences(text, "<script>"), chart::kLibraryScript.empty() ? 0U : 2U) << what;
  for (const FigureRead& figure : figures_in(page)) {
    EXPECT_FALSE(figure.columns.empty()) << what << ": " << figure.spec["label"];
  }
}

TEST(Html, IsSoundForOneThreeAndSevenAxes) {
  for (const std::size_t axes : {0U, 1U, 3U, 7U}) {
    const std::string page = report::report_html(synthetic::stream(axes));
    expect_sound(page, std::to_string(axes) + " axes");
    // What can't be shown becomes U+FFFD.
    EXPECT_EQ(without_programs(page).find("\uFFFD"), std::string::npos);
    // R² once; held-out rows, scatter, buffer, shares, departures and times of every axis.
    EXPECT_EQ(figures_in(page).size(), axes == 0 ? 0 : 1 + axes * 6);
  }
}

TEST(Html, WithTermsItShowsWhatTheModelBelieves) {
  const std::string heading = ">Coefficients</h2>";
  EXPECT_EQ(report::report_html(synthetic::stream(2)).find(heading), std::string::npos);
  study::StreamResult result = synthetic::stream_with_terms(2);
  result.axes[0].terms.clear();  // not every axis has to have them
  result.axes[1].terms[0].formula = "'<b>'*|u|";
  const std::string page = report::report_html(result);
  expect_sound(page, "terms");
  EXPECT_NE(page.find(heading), std::string::npos);
  EXPECT_EQ(figures_in(page).size(), 1U + 2 * 6 + 1 + 2);  // effects, and each of two
  EXPECT_NE(page.find("<td>0.001000</td><td>–</td><td>m/rev²</td><td>0.002000</td><td>−50 %</td>"),
            std::string::npos);
}

TEST(Html, EveryTotalIsShown) {
  study::StreamResult result = synthetic::stream(1);
  // NOLINTNEXTLINE(misc-const-correctness): written to through pointers to members
  Tally& tally = result.axes.front().status.tally;
  std::int64_t number = 7'100;
  for (const TallyField& field : tally_fields()) {
    tally.*field.total = ++number;
  }
  const std::string page = report::report_html(result);
  for (const TallyField& field : tally_fields()) {
    EXPECT_NE(page.find("<td>" + chart::grouped(tally.*field.total) + "</td>"), std::string::npos)
        << field.key;
  }
  // Words of the solver are under that heading.
  EXPECT_GT(page.find("<th>crowded out</th>"), page.find(">Solver</summary>"));
  EXPECT_GT(page.find("KKT<br/>gap"), page.find(">Solver</summary>"));
}

TEST(Html, SaysTheResultInWords) {
  study::StreamResult result = synthetic::stream(3);
  result.axes[1].r2_final = -0.31;
  result.axes[2].r2_final = synthetic::kNan;
  const std::string page = report::report_html(result);
  EXPECT_NE(page.find("Predictions of axis0 are very good, of axis1 worse than the mean, of axis2 "
                      "not measured"),
            std::string::npos);
}

TEST(Html, SaysWhereEverythingCameFrom) {
  const std::string page = report::report_html(synthetic::stream(1));
  for (const std::string fact :
       {"logs/dive_7.csv", "2,503 read, 3 skipped", "first 200 samples",
        "blocks of 400 rows, every 5th held out", "0.1,0.25,0.5", "4 Hz"}) {
    EXPECT_NE(page.find(fact), std::string::npos) << fact;
  }
  EXPECT_EQ(page.find("interrupted after"), std::string::npos);
}

TEST(Html, AnInterruptedRunSaysSoBeforeAnyResult) {
  const std::string page = report::report_html(synthetic::stopped_at_once());
  expect_sound(page, "stopped at once");
  const std::size_t notice = page.find("This run was interrupted after 20 of 2,000");
  ASSERT_NE(notice, std::string::npos);
  EXPECT_LT(notice, page.find("<table"));
  EXPECT_LT(notice, page.find("not measured"));
  EXPECT_TRUE(figures_in(page).empty()) << "no model, no empty figures";
}

TEST(Html, TheFirstScreenHasTheFindingTheVerdictTheInputsAndWhatIsNext) {
  study::StreamResult result = synthetic::stream_with_terms(2);
  result.commands = {"th1", "th2", "th3"};
  const std::string page = report::report_html(
      result, report::after_learning(result, {"dive.csv", "", ""}, "out/model.json"));
  expect_sound(page, "first screen");
  EXPECT_NE(
      page.find("<h1 dir=\"auto\">th2 gives 48 % of its thrust (41 to 55 %) since 120 s.</h1>"),
      std::string::npos)
      << page.substr(page.find("<h1"), 200);
  const std::size_t first = page.find("<nav");
  for (const char* const part :
       {"Predictions of axis0 and axis1 are very good", "<th>least squares</th>", "u, v, r",
        "th1, th2, th3", "kelpie rollout dive.csv --model out/model.json"}) {
    EXPECT_LT(page.find(part), first) << part;
  }
  EXPECT_EQ(page.find("Since 120.0 s: th2"), std::string::npos) << "said once, in the headline";
  for (const char* const folded : {"Nodes", "Solver", "Time per update", "Settings", "Data"}) {
    EXPECT_NE(page.find(std::string("<summary>") + folded + "</summary>"), std::string::npos);
  }
}

TEST(Html, AThrusterThatLostThrustIsNotWellAgain) {
  study::StreamResult result = synthetic::stream_with_terms(1);
  result.diagnosis.health = {{CauseKind::thruster, 3, 1.0, 0.9, 1.1},
                             {CauseKind::thruster, 4, 1.0, 0.9, 1.1}};
  const std::string before = "<td>100 %</td><td>90 %</td><td>110 %</td><td class=\"left\">–</td>";
  result.diagnosis.present = {{CauseKind::thruster, 3, 1.0, 1.0, 1.0},
                              {CauseKind::thruster, 4, 1.0, 1.0, 1.0}};
  EXPECT_EQ(occurrences(report::report_html(result), before), 2U);
  result.diagnosis.findings[0].settled = true;
  result.diagnosis.present[1] = {CauseKind::thruster, 4, 0.48, 0.41, 0.55};
  const std::string page = report::report_html(result);
  EXPECT_EQ(occurrences(page, before), 1U);
  EXPECT_NE(page.find("<td>48 %</td><td>40 %</td><td>56 %</td><td class=\"left\">at 120 s</td>"),
            std::string::npos);
}

TEST(Html, AThrustThatTheLastMinuteDoesNotTellIsNoNumber) {
  study::StreamResult result = synthetic::stream(1);
  result.diagnosis.present = {{CauseKind::thruster, 3, 1.0, 1.0, 1.0},
                              {CauseKind::thruster, 4, 1.0, 1.0, 1.0}};
  std::string page = report::report_html(result);
  EXPECT_EQ(page.find("<td>100 %</td>"), std::string::npos) << "never estimated";
  EXPECT_NE(page.find("The last minute does not tell the thrust of th1 and th2."),
            std::string::npos);
  result.diagnosis.health = {{CauseKind::thruster, 3, 0.4, -3.3, 4.1},
                             {CauseKind::thruster, 4, 1.0, 0.9, 1.1}};
  page = report::report_html(result);
  EXPECT_EQ(page.find("330 %"), std::string::npos);
  EXPECT_NE(page.find("<td>100 %</td><td>90 %</td><td>110 %</td>"), std::string::npos);
  EXPECT_NE(page.find("does not tell the thrust of th1."), std::string::npos);
}

TEST(Html, HostileTextFromTheLogIsShownNotRun) {
  for (const std::string& evil : {std::string("</script><script>alert(1)</script>\"'&\x01\xff"),
                                  // NOLINTNEXTLINE(misc-misleading-bidirectional)
                                  std::string("\u202eabc"), std::string(10'000, 'x')}) {
    study::StreamResult result = synthetic::stream_with_terms(2);
    result.source = "logs/" + evil;
    result.split = result.scales = evil;
    result.input_names.assign(result.input_names.size(), evil);
    result.settings = {{evil, evil}};
    result.axes[0].name = result.axes[0].unit = evil;
    result.axes[0].terms[0].formula = result.axes[0].terms[0].unit = evil;
    expect_sound(report::report_html(result), "hostile text");
  }
}

TEST(Html, EmptyConstantAndBrokenSeriesAreSound) {
  study::StreamResult result = synthetic::stream(5);
  result.axes[0].validation.resize(1);
  result.axes[1] = study::AxisResult{};
  result.axes[2].held_out_true.assign(result.axes[2].held_out_true.size(), 0.5);
  result.axes[2].held_out_predicted = result.axes[2].held_out_true;
  result.axes[2].update_us.assign(100, 0.0);
  for (double& value : result.axes[3].held_out_predicted) {
    value = std::numeric_limits<double>::infinity();
  }
  for (study::ValidationPoint& point : result.axes[4].validation) {
    point.r2 = synthetic::kNan;
  }
  result.rate_hz = synthetic::kNan;
  const std::string page = report::report_html(result);
  expect_sound(page, "odd series");
}

TEST(Html, ARunOfAHundredThousandSamplesIsAPageOfThreeMegabytes) {
  study::StreamResult result = synthetic::stream(3, 100'000);
  RandomStream random(1, "noise");
  for (study::AxisResult& axis : result.axes) {
    study::OneStep& steps = axis.one_step;
    for (std::size_t i = 0; i < 100'000; ++i) {
      const double time = 0.25 * static_cast<double>(i);
      const double half = 0.1 + 0.02 * std::sin(time / 500.0);
      steps.time_s.push_back(time);
      steps.predicted.push_back(std::sin(time / 40.0) + 0.02 * random.normal());
      steps.truth.push_back(steps.predicted.back() + 0.05 * random.normal());
      steps.lower.push_back(steps.predicted.back() - half);
      steps.upper.push_back(steps.predicted.back() + half);
      steps.configuration.push_back(0);
      steps.samples.push_back(i + 1);
    }
  }
  EXPECT_LT(report::report_html(result).size(), 3'000'000U);
}

TEST(Html, SameResultSameBytes) {
  EXPECT_EQ(report::report_html(synthetic::stream(2)), report::report_html(synthetic::stream(2)));
}

}  // namespace
}  // namespace kelpie::html_test
