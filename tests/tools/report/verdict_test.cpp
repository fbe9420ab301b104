// SPDX-License-Identifier: Apache-2.0
#include "report/verdict.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "chart/wording.hpp"
#include "report/synthetic.hpp"

namespace kelpie::verdict_test {
namespace {

study::StreamResult two_axes() {
  study::StreamResult result = synthetic::stream(2);
  result.commands = {"th1", "th2", "th3"};
  for (study::AxisResult& axis : result.axes) {
    axis.baselines.least_squares.r2_final = 0.93;
    axis.baselines.without_commands.r2_final = 0.4;
  }
  return result;
}

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(Verdict, TellsInputsQualityAndChangesInTenLines) {
  const std::string text = report::verdict_text(two_axes());
  EXPECT_TRUE(text.starts_with("Learned 2,000 rows of dive_7.csv (8 min at 4 Hz)\n")) << text;
  EXPECT_TRUE(has(text, "velocities: u, v, r\ncommands: th1, th2, th3\n")) << text;
  EXPECT_TRUE(has(text, "very good")) << text;
  EXPECT_TRUE(has(text, "vehicle: no change of the vehicle was found")) << text;
  EXPECT_FALSE(has(text, "WARNING"));
  EXPECT_LE(std::ranges::count(text, '\n'), 12) << text;
}

TEST(Verdict, SaysWhereALogIsTooShortForCauses) {
  study::StreamResult result = two_axes();
  result.diagnosis.has_reference = false;
  EXPECT_TRUE(has(report::verdict_text(result), "too short for causes"));
}

TEST(Verdict, SaysWhereLeastSquaresOrTheMeanIsBetter) {
  study::AxisResult axis = two_axes().axes.front();
  axis.r2_final = 0.85;
  EXPECT_EQ(report::verdict_of(axis), "good; least squares is better by 0.08");
  axis.r2_final = 0.005;
  EXPECT_EQ(report::verdict_of(axis), "no better than the mean");
  axis.r2_final = -0.3;
  EXPECT_EQ(report::verdict_of(axis), "worse than the mean");
  axis.r2_final = synthetic::kNan;
  EXPECT_EQ(report::verdict_of(axis), "not measured");
}

TEST(Verdict, TheHeadlineIsAWarningElseANamedCauseElseTheQuality) {
  study::StreamResult result = two_axes();
  result.axes[1].r2_final = 0.75;
  EXPECT_EQ(report::headline(result), "Predictions of axis0 are very good, of axis1 good");
  Finding finding;
  finding.since_s = 1500.25;
  finding.state = FindingState::looking;
  result.diagnosis.findings = {finding};
  EXPECT_EQ(report::headline(result), report::quality_sentence(result));
  result.diagnosis.findings[0].state = FindingState::named;
  result.diagnosis.findings[0].count = 1;
  result.diagnosis.findings[0].causes[0] = {CauseKind::thruster, 4, 0.6, 0.55, 0.65};
  EXPECT_EQ(report::headline(result), "th2 gives 60 % of its thrust (55 to 65 %) since 1500 s");
  for (study::AxisResult& axis : result.axes) {
    axis.status.ready = false;
  }
  EXPECT_TRUE(has(report::headline(result), "nothing was learned"));
}

TEST(Verdict, WarnsWhereTheCommandsSayNothing) {
  study::StreamResult result = two_axes();
  result.axes[0].baselines.without_commands.r2_final = 0.93;
  EXPECT_TRUE(has(report::verdict_of(result.axes[0]), "the commands say nothing"));
  EXPECT_FALSE(has(report::verdict_text(result), "WARNING")) << "yaw follows the commands";
  result.axes[1].baselines.without_commands.r2_final = 0.94;
  EXPECT_TRUE(has(report::verdict_text(result), "WARNING: these commands do not move"));
}

TEST(Verdict, ALeastSquaresGoneAstrayDoesNotBlameTheCommands) {
  study::AxisResult axis = two_axes().axes.front();
  axis.baselines.least_squares.r2_final = -1.4;
  axis.baselines.without_commands.r2_final = 0.2;
  EXPECT_EQ(report::verdict_of(axis), "very good");
  axis.r2_final = 0.2;
  EXPECT_TRUE(has(report::verdict_of(axis), "the commands say nothing"));
}

TEST(Verdict, WarnsWhereNothingWasLearned) {
  study::StreamResult result = two_axes();
  for (study::AxisResult& axis : result.axes) {
    axis.status.ready = false;
    axis.r2_final = synthetic::kNan;
  }
  EXPECT_TRUE(has(report::verdict_text(result), "WARNING: nothing was learned"));
}

TEST(Verdict, AChangeIsToldAndManyAreCounted) {
  study::StreamResult result = two_axes();
  for (std::size_t i = 0; i < 20; ++i) {
    const double since_s = 90.5 + static_cast<double>(i);
    result.axes[1].changes.push_back({.samples = i, .time_s = 200.0, .since_s = since_s});
  }
  const std::string text = report::verdict_text(result);
  EXPECT_TRUE(has(text, "vehicle: since 90.5 s: another model of " + result.axes[1].name)) << text;
  EXPECT_TRUE(has(text, "vehicle: and 14 more")) << text;
}

TEST(Verdict, AxesThatChangedTogetherShareALine) {
  study::StreamResult result = two_axes();
  result.axes[0].changes = {{.samples = 1, .time_s = 100.0, .since_s = 90.5}};
  result.axes[1].changes = {{.samples = 1, .time_s = 100.0, .since_s = 90.5},
                            {.samples = 9, .time_s = 300.0, .since_s = 280.0, .recalled = 1}};
  const std::string text = report::verdict_text(result);
  const std::string both = result.axes[0].name + ", " + result.axes[1].name;
  EXPECT_TRUE(has(text, "vehicle: since 90.5 s: another model of " + both + " fits")) << text;
  EXPECT_TRUE(has(text, "since 280 s: a past model of " + result.axes[1].name + " fits again"));
}

TEST(Verdict, ANamedChangeIsToldOnce) {
  study::StreamResult result = two_axes();
  result.axes[1].changes = {{.samples = 1, .time_s = 100.0, .since_s = 90.5},
                            {.samples = 2, .time_s = 300.0, .since_s = 290.0}};
  Finding finding;
  finding.since_s = 92.0;
  finding.state = FindingState::named;
  finding.count = 1;
  finding.causes[0] = {.kind = CauseKind::thruster, .place = 0, .size = 0.5};
  result.diagnosis.findings = {finding};
  const std::string text = report::verdict_text(result);
  EXPECT_FALSE(has(text, "since 90.5 s: another model")) << text;
  EXPECT_TRUE(has(text, "since 290 s: another model")) << "for no named cause";
}

// The first axis at its end: a thruster lost at 800 s, which held-out rows before and after.
study::StreamResult with_a_loss(std::size_t before, std::size_t after) {
  study::StreamResult result = two_axes();
  study::AxisResult& axis = result.axes.front();
  study::StageEnd stage;
  for (std::size_t i = 0; i < before + after; ++i) {
    const double truth = i % 2 == 0 ? 1.0 : -1.0;
    stage.time_s.push_back(800.0 + static_cast<double>(i) - static_cast<double>(before));
    stage.truth.push_back(truth);
    stage.predicted.push_back(i < before ? -truth : 0.6 * truth);  // R² 0.84 since then
  }
  axis.stages.push_back(stage);
  axis.r2_final = -0.952;
  Finding finding;
  finding.since_s = 800.0;
  finding.state = FindingState::named;
  finding.count = 1;
  finding.causes[0] = {CauseKind::thruster, 3, 0.7, 0.65, 0.75};
  result.diagnosis.findings = {finding};
  return result;
}

// Rows of before a loss are of another vehicle, and judge no model of the changed one.
TEST(Verdict, AfterAChangeTheRowsSinceThenJudge) {
  const study::StreamResult result = with_a_loss(300, 150);
  const std::string text = report::verdict_text(result);
  EXPECT_TRUE(has(text, "good since 800 s (R² 0.840)")) << text;
  EXPECT_TRUE(has(text, "also count held-out rows of before the change")) << text;
  EXPECT_FALSE(has(text, "worse than the mean")) << text;
  EXPECT_EQ(report::quality_sentence(result),
            "Predictions of axis0 are good since 800 s (R² 0.840), of axis1 very good");
  study::StreamResult poor = with_a_loss(300, 150);
  poor.axes.resize(1);
  EXPECT_FALSE(report::is_poor(poor));
  poor.diagnosis.findings.front().state = FindingState::looking;  // no change is believed
  EXPECT_TRUE(report::is_poor(poor));
  EXPECT_TRUE(has(report::verdict_text(poor), "worse than the mean\n"));
}

TEST(Verdict, TooFewRowsSinceAChangeAreNotEnoughForAFigure) {
  const std::string text = report::verdict_text(with_a_loss(300, 20));
  EXPECT_TRUE(has(text, "worse than the mean on rows mostly of before 800 s")) << text;
  EXPECT_FALSE(has(text, "also count")) << text;
}

TEST(Verdict, TheSettingForVelocitiesIsNamedInFull) {
  study::StreamResult result = two_axes();
  result.diagnosis.why_not = "unknown velocities";
  EXPECT_TRUE(has(report::vehicle_lines(result).front(), "--set states=… names one per target"));
  result.input_names = {"u", "w", "q", "th1"};
  result.axes[0].name = "wdot";
  result.axes[1].name = "q_dot";
  EXPECT_TRUE(report::vehicle_lines(result).front().ends_with(": --set states=w,q"))
      << report::vehicle_lines(result).front();
}

// A rudder's force goes with the square of the speed times the angle: beyond least squares.
TEST(Verdict, WhomTheCommandsSayNothingIsTold) {
  study::AxisResult axis = two_axes().axes.front();
  axis.baselines.without_commands.r2_final = 0.93;
  EXPECT_EQ(report::verdict_of(axis), "very good; the commands say nothing to least squares");
}

TEST(Verdict, LinesFitAHundredColumns) {
  study::StreamResult result = two_axes();
  result.commands.clear();
  for (int i = 0; i < 40; ++i) {
    result.commands.push_back("thruster_" + std::to_string(i));
  }
  result.input_names = result.commands;
  result.source = std::string(300, 's');
  std::istringstream lines(report::verdict_text(result));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
}

}  // namespace
}  // namespace kelpie::verdict_test
