// SPDX-License-Identifier: Apache-2.0
#include "report/interval_figures.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "chart/markup_check.hpp"
#include "format/result_json.hpp"
#include "report/html.hpp"
#include "report/synthetic.hpp"
#include "report/table.hpp"

namespace kelpie::interval_figures_test {
namespace {

constexpr chart::PlotSize kSize{400, 250};

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
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

// A figure with its frame, and no coordinate that isn't a number.
void expect_drawable(const std::string& svg) {
  EXPECT_EQ(take_apart(svg).fault, "");
  EXPECT_FALSE(of_class(svg, "tick").empty()) << svg;
  EXPECT_FALSE(says(svg, "nan") || says(svg, "inf")) << svg;
}

TEST(IntervalFigures, TheBandHasItsNameInTheLegendAndTheAxesTheirUnits) {
  const chart::Panel panel = report::interval_panel(stream_with_intervals().axes[0], kSize);
  EXPECT_EQ(of_class(panel.svg, "band").size(), 2U);  // the band, and its sample in the legend
  for (const char* const text : {">interval</text>", ">true</text>", ">predicted</text>",
                                 ">axis0 in m s^-2</text>", ">time in s</text>"}) {
    EXPECT_TRUE(says(panel.svg, text)) << text;
  }
  EXPECT_TRUE(says(panel.caption, "The last 200 training samples"));
}

TEST(IntervalFigures, WhatIsMissingIsLeftOutWithoutHarm) {
  study::AxisResult axis = stream_with_intervals().axes[0];
  axis.one_step.lower.assign(1200, -std::numeric_limits<double>::infinity());
  axis.one_step.upper.assign(1200, std::numeric_limits<double>::infinity());
  const std::string without_band = report::interval_panel(axis, kSize).svg;
  expect_drawable(without_band);
  // Truth, prediction and their samples in the legend; of the band that sample only.
  EXPECT_EQ(of_class(without_band, "line").size(), 4U);
  EXPECT_EQ(of_class(without_band, "band").size(), 1U);
  for (const std::string& svg : {report::interval_panel(study::AxisResult{}, kSize).svg,
                                 report::novelty_panel(study::AxisResult{}, kSize).svg,
                                 report::coverage_panel(synthetic::stream(2), kSize).svg}) {
    expect_drawable(svg);
    EXPECT_TRUE(says(svg, ">no data</text>")) << svg;
  }
}

TEST(IntervalFigures, TableJsonAndPageAgree) {
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
  EXPECT_TRUE(says(page, "<h2>Intervals one step ahead (promised: 0.9)</h2>"));
  EXPECT_TRUE(says(page, "Error by novelty"));
}

TEST(IntervalFigures, ALearnerWithoutIntervalsHasNoSection) {
  const study::StreamResult result = synthetic::stream(1);
  EXPECT_FALSE(says(report::result_table(result), "Intervals"));
  EXPECT_FALSE(says(report::report_html(result), "Intervals"));
  EXPECT_TRUE(says(format::result_json(result), "\"intervals\": null"));
}

}  // namespace
}  // namespace kelpie::interval_figures_test
