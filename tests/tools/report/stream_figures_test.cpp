// SPDX-License-Identifier: Apache-2.0
#include "report/stream_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "chart/figure_check.hpp"
#include "format/result_json.hpp"
#include "report/html.hpp"
#include "report/synthetic.hpp"
#include "report/table.hpp"

namespace kelpie::stream_figures_test {
namespace {

const report::Clock kClock{};

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

FigureRead read(const std::string& html) {
  return figures_in(html).at(0);
}

std::set<std::string> marks_of(const FigureRead& figure) {
  std::set<std::string> names;
  for (const nlohmann::json& mark : figure.spec["marks"]) {
    names.insert(mark["name"].get<std::string>());
  }
  return names;
}

// 1,200 predictions, one in ten outside, with intervals from the 31st on.
study::StreamResult stream_with_intervals() {
  study::StreamResult result = synthetic::stream(1);
  result.settings.emplace_back("coverage", "0.9");
  study::AxisResult& axis = result.axes[0];
  axis.unit = "m s^-2";
  study::OneStep& steps = axis.one_step;
  for (std::size_t i = 0; i < 1200; ++i) {
    const double half = i < 30 ? std::numeric_limits<double>::infinity() : 0.01;
    steps.time_s.push_back(0.25 * static_cast<double>(i));
    steps.configuration.push_back(0);
    steps.samples.push_back(i + 1);
    steps.truth.push_back(i % 10 == 0 ? 0.02 : 0.0);
    steps.predicted.push_back(0.0);
    steps.lower.push_back(-half);
    steps.upper.push_back(half);
  }
  axis.coverage = study::coverage_of(steps);
  axis.novelty.assign(10, study::NoveltyBin{});
  axis.novelty[3] = {0.3, 0.4, 250, 0.004, 0.93};
  return result;
}

TEST(StreamFigures, TheCourseHoldsTheWholeRunWithUnitsIntervalChangesAndOutliers) {
  study::AxisResult axis = stream_with_intervals().axes[0];
  axis.changes = {{100, 25.0, 20.0, 0, 0}, {200, 50.0, 49.0, 3, 0}};
  axis.outliers = {{300, 75.0, 0.02}};
  const FigureRead figure = read(report::course_figure(axis, kClock));
  EXPECT_EQ(figure.spec["y"]["label"], "axis0 in m/s²");
  EXPECT_EQ(figure.spec["x"]["label"], "time in s");
  EXPECT_EQ(figure.values("measured").size(), 1200U);
  EXPECT_NEAR(figure.values("measured")[10], 0.02, 1e-5);
  EXPECT_TRUE(std::isnan(figure.values("interval", "half")[29]));
  EXPECT_NEAR(figure.values("interval", "half")[30], 0.01, 1e-9);
  EXPECT_EQ(figure.values("outliers removed", "x"), (std::vector<double>{75.0}));
  EXPECT_EQ(marks_of(figure), (std::set<std::string>{"change", "known again"}));
}

TEST(StreamFigures, OfALongRunAMinuteIsShownFirstAndTheErrorsBelow) {
  study::StreamResult result = stream_with_intervals();
  study::OneStep& steps = result.axes[0].one_step;
  result.axes[0].validation.clear();  // they reach further than the samples
  result.axes[0].held_out_time_s.clear();
  for (std::size_t i = 900; i < 1000; ++i) {
    steps.truth[i] += i % 2 == 0 ? 0.03 : -0.03;  // the liveliest, from 225 s to 250 s
  }
  const report::Clock clock = report::clock_of(result);
  EXPECT_NEAR(clock.first.high - clock.first.low, 60.0, 1e-9);
  EXPECT_LE(clock.first.low, 225.0);
  EXPECT_GE(clock.first.high, 250.0);
  const FigureRead figure = read(report::course_figure(result.axes[0], clock));
  EXPECT_EQ(figure.spec["start"], nlohmann::json({clock.first.low, clock.first.high}));
  EXPECT_EQ(figure.spec["errors"]["label"], "error in m/s²");
  EXPECT_FALSE(figure.series(figure.spec["errors"]["of"].get<std::string>()).is_null());

  Finding finding;
  finding.since_s = 100.0;
  finding.state = FindingState::named;
  result.diagnosis.findings = {finding};
  EXPECT_NEAR(report::clock_of(result).first.low, 85.0, 1e-9) << "around the change";
  steps.time_s.resize(300);
  EXPECT_EQ(report::clock_of(result).first.high, steps.time_s.back()) << "all of a short run";
}

TEST(StreamFigures, OneWildValueDoesNotFlattenTheOthers) {
  study::AxisResult axis = stream_with_intervals().axes[0];
  axis.one_step.truth[600] = 1e30;
  const std::string html = report::course_figure(axis, kClock);
  EXPECT_LT(read(html).values("measured")[600], 1.0);
  EXPECT_NEAR(read(html).values("measured")[10], 0.02, 1e-5);
  EXPECT_TRUE(says(html, "1 values far outside the others are drawn at the edge"));
}

TEST(StreamFigures, AllFiguresOverTimeAreLinked) {
  const study::StreamResult result = stream_with_intervals();
  std::size_t linked = 0;
  for (const FigureRead& figure : figures_in(report::report_html(result))) {
    const bool over_time = figure.spec["x"]["label"] == "time in s";
    EXPECT_EQ(figure.spec.contains("link"), over_time) << figure.spec["label"];
    linked += over_time ? 1U : 0U;
  }
  EXPECT_GE(linked, 6U);
}

TEST(StreamFigures, R2BelowTheFigureIsCountedAndNamed) {
  study::StreamResult result = synthetic::stream(1);
  EXPECT_FALSE(says(report::r2_figure(result, kClock), "below the figure"));
  result.axes[0].validation[3].r2 = -20.0;
  result.axes[0].validation[7].r2 = -3.0;
  const std::string html = report::r2_figure(result, kClock);
  EXPECT_TRUE(says(html, "2 points lie below the figure, the lowest at −20 (axis0)")) << html;
  EXPECT_EQ(read(html).spec["y"]["range"], nlohmann::json({-0.2, 1.0}));
}

TEST(StreamFigures, EveryChangeOfTheVehicleIsMarked) {
  study::StreamResult result = synthetic::stream(2);
  for (study::AxisResult& axis : result.axes) {
    for (std::size_t i = 10; i < axis.validation.size(); ++i) {
      axis.validation[i].configuration = i < 25 ? 2 : 3;
    }
  }
  for (const std::string& html :
       {report::r2_figure(result, kClock), report::buffer_figure(result.axes[0], kClock)}) {
    EXPECT_EQ(marks_of(read(html)), (std::set<std::string>{"configuration 2", "configuration 3"}));
  }
}

TEST(StreamFigures, EffectsAndCoefficientsHaveTheirUnitsAndErrors) {
  const study::AxisResult axis = synthetic::stream_with_terms(1).axes[0];
  const FigureRead effects = read(report::effects_figure(axis, kClock));
  EXPECT_EQ(effects.spec["y"]["label"], "effect in m/s²");
  EXPECT_EQ(effects.spec["series"].size(), 4U);  // two lines, two bands
  const std::vector<std::string> each = report::coefficient_figures(axis, kClock);
  ASSERT_EQ(each.size(), 2U);
  const FigureRead thrust = read(each[1]);
  EXPECT_EQ(thrust.spec["y"]["label"], "coefficient in m/rev²");
  EXPECT_NEAR(thrust.values("max(th1,0)^2").back(), 0.001, 1e-7);
  EXPECT_NEAR(thrust.columns.at(thrust.spec["series"][0]["half"].get<std::size_t>()).back(), 1e-4,
              1e-9);
}

TEST(StreamFigures, OfManyTermsTheLargestAreDrawnAndThatIsSaid) {
  study::AxisResult axis = synthetic::stream_with_terms(1).axes[0];
  axis.unit = "";
  axis.terms.assign(20, {"small", "", 1.0});
  axis.terms[13].formula = "large";
  for (study::ValidationPoint& point : axis.validation) {
    point.coefficients.assign(20, 0.0);
    point.errors.assign(20, 0.0);
    point.coefficients[13] = -2.0;
  }
  const std::string html = report::effects_figure(axis, kClock);
  EXPECT_FALSE(read(html).series("large").is_null());
  EXPECT_EQ(read(html).spec["y"]["label"], "effect in the target's unit");
  EXPECT_TRUE(says(html, "The 7 largest of 20 terms"));
}

TEST(StreamFigures, TheFirstWildCoefficientsDoNotFlattenTheOthers) {
  study::AxisResult axis = synthetic::stream_with_terms(1).axes[0];
  EXPECT_FALSE(read(report::effects_figure(axis, kClock)).spec["y"].contains("range"));
  axis.validation[2].coefficients[0] = 5000.0;
  axis.validation[3].errors[0] = 9000.0;
  const std::string html = report::effects_figure(axis, kClock);
  ASSERT_TRUE(read(html).spec["y"].contains("range"));
  const nlohmann::json range = read(html).spec["y"]["range"];
  EXPECT_LT(range[1].get<double>(), 1.0);
  EXPECT_LE(range[0].get<double>(), -0.2) << "the damping stays in view";
  EXPECT_TRUE(says(html, "Values far outside the others are cut off."));
  EXPECT_TRUE(says(report::coefficient_figures(axis, kClock)[0], "cut off"));
}

TEST(StreamFigures, ALateStepOfACoefficientStaysInView) {
  study::AxisResult axis = synthetic::stream_with_terms(1).axes[0];
  axis.validation[2].coefficients[1] = 1.0;
  axis.validation.back().coefficients[1] = 0.5;
  const nlohmann::json spec = read(report::coefficient_figures(axis, kClock)[1]).spec;
  ASSERT_TRUE(spec["y"].contains("range"));
  EXPECT_GE(spec["y"]["range"][1].get<double>(), 0.5);
  EXPECT_LT(spec["y"]["range"][1].get<double>(), 1.0);
}

// Held-out rows of 100 s to 200 s and of 300 s to 400 s; the first window lies between.
TEST(StreamFigures, HeldOutRowsOverTimeBeginWhereThereAreSome) {
  study::AxisResult axis;
  axis.name = "udot";
  for (const double begin : {100.0, 300.0}) {
    for (double time = begin; time < begin + 100.0; time += 0.25) {
      axis.held_out_time_s.push_back(time);
      axis.held_out_true.push_back(time);
      axis.held_out_predicted.push_back(time);
    }
  }
  const auto start = [&](double from) {
    const report::Clock clock{0.0, {0.0, 500.0}, {from, from + 60.0}};
    return read(report::held_out_figure(axis, clock)).spec["start"];
  };
  EXPECT_EQ(start(220.0), nlohmann::json({300.0, 360.0}));
  EXPECT_EQ(start(150.0), nlohmann::json({150.0, 210.0})) << "rows there already";
  EXPECT_EQ(start(430.0)[1], axis.held_out_time_s.back()) << "the last ones";
}

TEST(StreamFigures, RowsThatR2DoesNotCountAreTold) {
  study::AxisResult axis = synthetic::axis("a", 100, 40);
  axis.stages.resize(2);
  const auto last = axis.held_out_time_s.begin() + 30;
  axis.stages[0].time_s.assign(axis.held_out_time_s.begin(), last);
  axis.stages[1].time_s.assign(last, axis.held_out_time_s.end());
  const std::string html = report::scatter_figure(axis);
  EXPECT_EQ(read(html).values("earlier").size(), 30U);
  EXPECT_EQ(read(html).values("last").size(), 10U);
  EXPECT_TRUE(says(html, "R² counts the last configuration alone."));
  axis.stages = {axis.stages[1]};
  axis.stages[0].time_s = axis.held_out_time_s;
  EXPECT_EQ(read(report::scatter_figure(axis)).values("held-out row").size(), 40U);
  EXPECT_TRUE(says(report::scatter_figure(axis), ">40 held-out rows; on the dashed"));
}

TEST(StreamFigures, ScatterSaysHowFarItIsThinned) {
  const std::string html = report::scatter_figure(synthetic::axis("a", 100, 4000));
  EXPECT_TRUE(says(html, "1,500 of 4,000 held-out rows"));
  EXPECT_EQ(read(html).values("held-out row").size(), 1500U);
}

TEST(StreamFigures, SharesAreOfAllSamplesOfTheInterval) {
  const FigureRead figure = read(report::shares_figure(synthetic::axis("a", 2000, 10), kClock));
  EXPECT_EQ(figure.spec["series"].size(), 3U);  // of the five rules, those that decided anything
  EXPECT_NEAR(figure.values("accepted").back(), 50.0, 3.0);
  EXPECT_TRUE(says(report::shares_figure(study::AxisResult{}, kClock), "There is no data"));
}

TEST(StreamFigures, TimesOfZeroAreDrawnAndSaid) {
  study::AxisResult axis = synthetic::axis("a", 100, 10);
  EXPECT_FALSE(says(report::timing_figure(axis), "of 0 µs"));
  axis.update_us.assign(100, 0.0);
  const std::string html = report::timing_figure(axis);
  EXPECT_TRUE(says(html, "100 updates of 0 µs"));
  EXPECT_TRUE(marks_of(read(html)).contains("median 0.0 µs"));
}

TEST(StreamFigures, WhatIsMissingIsLeftOutWithoutHarm) {
  study::AxisResult axis = stream_with_intervals().axes[0];
  axis.one_step.lower.assign(1200, -std::numeric_limits<double>::infinity());
  axis.one_step.upper.assign(1200, std::numeric_limits<double>::infinity());
  EXPECT_EQ(read(report::course_figure(axis, kClock)).spec["series"].size(), 2U);
  for (const std::string& html : {report::course_figure(study::AxisResult{}, kClock),
                                  report::novelty_figure(study::AxisResult{}),
                                  report::coverage_figure(synthetic::stream(2), kClock)}) {
    EXPECT_EQ(take_apart(html).fault, "");
    EXPECT_TRUE(says(html, "There is no data")) << html;
  }
}

TEST(StreamFigures, TableJsonAndPageAgreeOnIntervals) {
  const study::StreamResult result = stream_with_intervals();
  const std::string table = report::result_table(result);
  EXPECT_TRUE(says(table, "Intervals one step ahead (promised: 0.9)"));
  EXPECT_TRUE(says(table, "1,170  90.0 %  90.0 %     0.02000"));
  const std::string json = format::result_json(result);
  EXPECT_TRUE(says(json, "\"held\": 0.9,"));
  EXPECT_TRUE(says(json, "\"lowest_of_500\": 0.9,"));
  EXPECT_TRUE(says(json, "\"rms_error\": 0.004,"));
  EXPECT_TRUE(says(json, "\"rms_error\": null"));
  const std::string page = report::report_html(result);
  EXPECT_TRUE(says(page, "<td>90.0 %</td>"));
  EXPECT_TRUE(says(page, "<summary>Intervals one step ahead (promised: 0.9)</summary>"));
  EXPECT_TRUE(says(page, "Error by novelty"));
}

TEST(StreamFigures, ALearnerWithoutIntervalsHasNoSectionOnThem) {
  const study::StreamResult result = synthetic::stream(1);
  EXPECT_FALSE(says(report::result_table(result), "Intervals"));
  EXPECT_FALSE(says(report::report_html(result), "Intervals one"));
  EXPECT_TRUE(says(format::result_json(result), "\"intervals\": null"));
}

}  // namespace
}  // namespace kelpie::stream_figures_test
