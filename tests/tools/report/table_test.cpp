// SPDX-License-Identifier: Apache-2.0
#include "report/table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <sstream>

#include "chart/wording.hpp"
#include "report/synthetic.hpp"

namespace kelpie::table_test {
namespace {

std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) {
    all.push_back(line);
  }
  return all;
}

// The two head lines and one line per axis, which stand between two blank lines.
std::vector<std::string> body(const std::string& text) {
  const std::vector<std::string> all = lines(text);
  const auto first = std::next(std::find(all.begin(), all.end(), ""));
  return {first, std::find(first, all.end(), "")};
}

TEST(Table, ColumnsEndAtTheSamePlaceWhateverTheLetters) {
  study::StreamResult result = synthetic::stream(3);
  result.axes[0].name = "ṙ̈";
  result.axes[1].name = "wdot";
  result.axes[1].r2_final = -0.204;
  result.axes[2].r2_mean = synthetic::kNan;
  const std::vector<std::string> rows = body(report::result_table(result));
  ASSERT_EQ(rows.size(), 5U);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(chart::code_points(rows[i]), chart::code_points(rows[1])) << rows[i];
  }
  EXPECT_NE(rows[3].find("−0.204"), std::string::npos);
}

TEST(Table, FitsAHundredColumnsWhateverTheNumbers) {
  study::StreamResult result = synthetic::stream(7);
  result.source = std::string(300, 's');
  result.split = std::string(300, 'p');
  for (study::AxisResult& axis : result.axes) {
    axis.name = std::string(60, 'n');
    axis.r2_final = axis.r2_mean = axis.r2_min_after_1000 = axis.prequential_r2 = -1.5e8;
    axis.update_us = {9.9e8};
    axis.status.support_vectors = 987'654;
    axis.status.tally.accepted = axis.status.tally.explained = 123'456'789;
    axis.status.tally.outliers = axis.status.tally.forgotten = 123'456'789;
  }
  for (const std::string& line : lines(report::result_table(result))) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
  EXPECT_NE(report::result_table(result).find("n…"), std::string::npos);
}

TEST(Table, SaysTheSplitTheRowsAndAnInterruption) {
  const std::string whole = report::result_table(synthetic::stream(1));
  EXPECT_NE(whole.find("split: blocks of 400 rows, every 5th held out"), std::string::npos);
  EXPECT_NE(whole.find("2,000 for training, 500 held out"), std::string::npos);
  EXPECT_EQ(whole.find("INTERRUPTED"), std::string::npos);
  const std::string stopped = report::result_table(synthetic::stopped_at_once());
  EXPECT_NE(stopped.find("INTERRUPTED after 20 of 2,000"), std::string::npos);
}

TEST(Table, NamesCannotCommandTheTerminal) {
  study::StreamResult result = synthetic::stream(1);
  result.axes.front().name = "\x1b[2J";
  result.split = "a\rb";
  EXPECT_EQ(report::result_table(result).find_first_of("\x1b\r"), std::string::npos);
}

TEST(Table, TroubleIsSaidWhereThereWasAny) {
  study::StreamResult result = synthetic::stream(2);
  EXPECT_EQ(report::result_table(result).find("crowded out"), std::string::npos);
  Tally& tally = result.axes[1].status.tally;
  tally.crowded_out = 12;
  tally.fallbacks = 1;
  tally.unfinished = 40;
  EXPECT_NE(
      report::result_table(result).find("axis1: 12 crowded out, 40 unfinished, 1 solved by SMO\n"),
      std::string::npos)
      << report::result_table(result);
}

TEST(Table, CoefficientsStandBelowWithUnitsAndChange) {
  const std::string text = report::result_table(synthetic::stream_with_terms(2));
  EXPECT_EQ(report::result_table(synthetic::stream(2)).find("coefficient"), std::string::npos);
  EXPECT_NE(text.find("axis1 in m/s²\n"), std::string::npos) << text;
  const std::vector<std::string> all = lines(text);
  const auto row = std::ranges::find_if(
      all, [](const std::string& line) { return line.find("max(th1,0)^2") != std::string::npos; });
  ASSERT_NE(row, all.end());
  std::istringstream words(*row);
  const std::vector<std::string> cells{std::istream_iterator<std::string>(words), {}};
  EXPECT_EQ(cells, (std::vector<std::string>{"max(th1,0)^2", "0.001000", "–", "m/rev²", "0.002000",
                                             "−50", "%", "0.04000"}));
}

TEST(Table, CoefficientsFitAHundredColumnsWhateverTheirTexts) {
  study::StreamResult result = synthetic::stream_with_terms(1);
  result.axes[0].terms[0] = {std::string(90, 'f'), std::string(90, 'u'), 1e-300};
  for (study::ValidationPoint& point : result.axes[0].validation) {
    if (!point.coefficients.empty()) {
      point.coefficients[0] = -1.2345e-123;
    }
  }
  for (const std::string& line : lines(report::result_table(result))) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
}

TEST(Table, TheDisturbanceStandsBesideOneStepAheadWithItsOwnIntervals) {
  study::StreamResult result = synthetic::stream(1);
  result.axes.front().coverage = {1900, 0.899, 0.87, 0.5, 0.4};
  result.axes.front().corrected_coverage = {1900, 0.901, 0.88, 0.25, 0.2};
  const std::string text = report::result_table(result);
  EXPECT_NE(text.find("0.974             0.991"), std::string::npos) << text;
  EXPECT_NE(text.find("axis0 with disturbance    1,900  90.1 %"), std::string::npos) << text;
}

TEST(Table, WithoutAxesThereIsStillAHead) {
  EXPECT_EQ(body(report::result_table(synthetic::stream(0))).size(), 2U);
}

}  // namespace
}  // namespace kelpie::table_test
