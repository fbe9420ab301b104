// SPDX-License-Identifier: Apache-2.0
#include "report/stream_figures.hpp"

#include <gtest/gtest.h>

#include "chart/markup_check.hpp"
#include "report/synthetic.hpp"

namespace kelpie::stream_figures_test {
namespace {

constexpr chart::PlotSize kSize{400, 250};

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(StreamFigures, ClippedR2IsCountedAndNamed) {
  study::StreamResult result = synthetic::stream(1);
  EXPECT_FALSE(says(report::r2_panel(result, kSize).caption, "Clipped"));
  result.axes[0].validation[3].r2 = -20.0;
  result.axes[0].validation[7].r2 = -3.0;
  const chart::Panel panel = report::r2_panel(result, kSize);
  EXPECT_TRUE(says(panel.caption, "(2 of them, the lowest −20 for axis0)"));
  EXPECT_TRUE(says(panel.svg, ">−0.2</text>"));
}

TEST(StreamFigures, EveryChangeOfTheVehicleIsMarked) {
  study::StreamResult result = synthetic::stream(2);
  for (study::AxisResult& axis : result.axes) {
    for (std::size_t i = 10; i < axis.validation.size(); ++i) {
      axis.validation[i].configuration = i < 25 ? 2 : 3;
    }
  }
  for (const chart::Panel& panel :
       {report::r2_panel(result, kSize), report::buffer_panel(result.axes[0], kSize)}) {
    EXPECT_EQ(of_class(panel.svg, "mark").size(), 2U);
    EXPECT_TRUE(says(panel.svg, ">configuration 2</text>"));
    EXPECT_TRUE(says(panel.svg, ">configuration 3</text>"));
  }
}

TEST(StreamFigures, EffectsAreDrawnPerTermInTheTargetsUnit) {
  const chart::Panel panel =
      report::coefficients_panel(synthetic::stream_with_terms(1).axes[0], kSize);
  EXPECT_TRUE(says(panel.svg, ">effect in m s^-2</text>"));
  EXPECT_TRUE(says(panel.svg, ">u*|u|</text>"));
  EXPECT_TRUE(says(panel.svg, ">max(th1,0)^2</text>"));
  EXPECT_TRUE(says(panel.svg, ">configuration 2</text>"));
  EXPECT_FALSE(says(panel.caption, "largest of"));
}

TEST(StreamFigures, OfManyTermsTheLargestAreDrawnAndThatIsSaid) {
  study::AxisResult axis = synthetic::stream_with_terms(1).axes[0];
  axis.unit = "";
  axis.terms.assign(20, {"small", "", 1.0});
  axis.terms[13].formula = "large";
  for (study::ValidationPoint& point : axis.validation) {
    point.coefficients.assign(20, 0.0);
    point.coefficients[13] = -2.0;
  }
  const chart::Panel panel = report::coefficients_panel(axis, kSize);
  EXPECT_TRUE(says(panel.svg, ">large</text>"));
  EXPECT_TRUE(says(panel.svg, ">effect in the target&#39;s unit</text>"));
  EXPECT_TRUE(says(panel.caption, "The 7 largest of 20 terms"));
}

TEST(StreamFigures, ScatterSaysHowFarItIsThinned) {
  const chart::Panel panel = report::scatter_panel(synthetic::axis("a", 100, 4000), kSize);
  EXPECT_TRUE(says(panel.caption, "1,500 of 4,000 held-out rows"));
  EXPECT_EQ(occurrences(of_class(panel.svg, "dot").at(0)["d"], "h0"), 1500U);
}

TEST(StreamFigures, StretchSaysWhetherRowsAreJoined) {
  study::StreamResult result = synthetic::stream(1);
  study::AxisResult& axis = result.axes[0];
  EXPECT_TRUE(
      says(report::stretch_panel(result, axis, kSize).caption, "gaps in time are not joined"));
  for (std::size_t i = 0; i < axis.held_out_time_s.size(); ++i) {
    axis.held_out_time_s[i] = 1.7e9 + static_cast<double>(i);
  }
  const chart::Panel panel = report::stretch_panel(result, axis, kSize);
  EXPECT_TRUE(says(panel.caption, "stand alone in time"));
  EXPECT_TRUE(of_class(panel.svg, "line").empty());
  EXPECT_TRUE(says(panel.svg, "time in s after 1700000"));
}

// The height of a box from its path "Mx yHxVyHxz".
double height_of_first_box(const Element& boxes) {
  const std::string path = boxes["d"];
  const double low = std::stod(path.substr(path.find(' ')));
  return low - std::stod(path.substr(path.find('V') + 1));
}

TEST(StreamFigures, SharesFillThePanelInProportion) {
  const chart::Panel panel = report::shares_panel(synthetic::axis("a", 2000, 10), kSize);
  const std::string empty = report::shares_panel(study::AxisResult{}, kSize).svg;
  EXPECT_TRUE(says(empty, "no data"));
  std::vector<double> heights;
  for (const Element& boxes : of_class(panel.svg, "box")) {
    if (boxes["d"].find('V') != std::string::npos) {  // the legend's boxes are drawn otherwise
      heights.push_back(height_of_first_box(boxes));
    }
  }
  ASSERT_EQ(heights.size(), 3U);
  EXPECT_NEAR(heights[0] / (heights[0] + heights[1] + heights[2]), 0.5, 0.03);
}

TEST(StreamFigures, TimesOfZeroAreDrawnAndSaid) {
  study::AxisResult axis = synthetic::axis("a", 100, 10);
  EXPECT_EQ(report::timing_panel(axis, kSize).caption, "");
  axis.update_us.assign(100, 0.0);
  const chart::Panel panel = report::timing_panel(axis, kSize);
  EXPECT_TRUE(says(panel.caption, "100 updates of 0 µs"));
  EXPECT_TRUE(says(panel.svg, ">median 0.0 µs</text>"));
}

}  // namespace
}  // namespace kelpie::stream_figures_test
