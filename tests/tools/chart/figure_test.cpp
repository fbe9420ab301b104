// SPDX-License-Identifier: Apache-2.0
#include "chart/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "chart/figure_check.hpp"

namespace kelpie::figure_test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

chart::Figure figure() {
  return {{"time in s"}, {"speed in m/s"}, "a figure"};
}

FigureRead read(const chart::Figure& drawing) {
  return figures_in(drawing.html()).at(0);
}

TEST(Figure, HoldsEverySampleToAThirtyThousandthOfTheRange) {
  std::vector<chart::Point> points;
  for (int i = 0; i < 5000; ++i) {
    points.push_back({1.7e9 + 0.1 * i, 3.0 * std::sin(0.37 * i)});
  }
  chart::Figure drawing = figure();
  drawing.line(points, 0, "speed");
  const FigureRead shown = read(drawing);
  const std::vector<double> x = shown.values("speed", "x");
  const std::vector<double> y = shown.values("speed");
  ASSERT_EQ(y.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(x[i], points[i].x, 1e-6);
    EXPECT_NEAR(y[i], points[i].y, 6.0 / 65'534);
  }
}

TEST(Figure, WhatIsNotFiniteBreaksALineAndHasNoPlaceInTime) {
  chart::Figure drawing = figure();
  drawing.line(std::vector<chart::Point>{{0, 0}, {1, NAN}, {2, kInf}, {NAN, 5}, {3, 1}}, 0, "line");
  drawing.dots(std::vector<chart::Point>{{NAN, NAN}, {-kInf, kInf}}, 1, "dots");
  drawing.mark(NAN, "nowhere");
  const FigureRead shown = read(drawing);
  EXPECT_EQ(shown.spec["series"].size(), 1U);
  EXPECT_TRUE(shown.spec["marks"].empty());
  const std::vector<double> y = shown.values("line");
  ASSERT_EQ(y.size(), 4U);
  EXPECT_EQ(y[0], 0.0);
  EXPECT_TRUE(std::isnan(y[1]) && std::isnan(y[2]));
  EXPECT_EQ(y[3], 1.0);
}

TEST(Figure, ColumnsThatAreAlikeAreKeptOnce) {
  chart::Figure drawing = figure();
  const std::vector<chart::Point> middle{{0, 1}, {1, 2}, {2, 4}};
  drawing.band(middle, std::vector<double>{0.5, kInf, 0.25}, 1, "interval");
  drawing.line(middle, 1, "predicted");
  const FigureRead shown = read(drawing);
  EXPECT_EQ(shown.columns.size(), 3U);
  EXPECT_EQ(shown.series("interval")["y"], shown.series("predicted")["y"]);
  const std::vector<double> half = shown.values("interval", "half");
  EXPECT_EQ(half[0], 0.5);
  EXPECT_TRUE(std::isnan(half[1]));
}

TEST(Figure, ABandWithoutAnyWidthIsLeftOut) {
  chart::Figure drawing = figure();
  drawing.band(std::vector<chart::Point>{{0, 1}, {1, 2}}, std::vector<double>{kInf, kInf}, 1, "b");
  EXPECT_TRUE(figures_in(drawing.html()).empty());
}

TEST(Figure, CloudsOfPointsAreSorted) {
  chart::Figure drawing = figure();
  drawing.dots(std::vector<chart::Point>{{3, 1}, {1, 2}, {2, 3}}, 0, "dots");
  EXPECT_EQ(read(drawing).values("dots", "x"), (std::vector<double>{1, 2, 3}));
}

TEST(Figure, WithoutJavaScriptASentenceSaysWhatIsShown) {
  chart::Figure drawing = figure();
  drawing.line(std::vector<chart::Point>{{0, -0.25}, {1, 1.5}}, 0, "speed");
  EXPECT_NE(
      drawing.html("below").find(">a figure. speed in m/s, over time in s: speed from −0.2500 "
                                 "to 1.500.</p>"),
      std::string::npos)
      << drawing.html();
  EXPECT_NE(drawing.html("below").find("<figcaption>below</figcaption>"), std::string::npos);
  EXPECT_NE(figure().html().find("There is no data"), std::string::npos);
}

TEST(Figure, HostileTextIsDataOnly) {
  for (const std::string& evil :
       // NOLINTNEXTLINE(misc-misleading-bidirectional)
       {std::string("</script><script>alert(1)</script>\"'&<!--"), std::string("\u202e\u2066abc"),
        std::string("\x01\xff"), std::string(10'000, 'x')}) {
    chart::Figure drawing({evil}, {evil}, evil);
    drawing.line(std::vector<chart::Point>{{0, 0}, {1, 1}}, 0, evil);
    drawing.mark(0.5, evil);
    drawing.link(evil);
    const std::string html = drawing.html(evil.substr(0, 100));
    EXPECT_EQ(take_apart(html).fault, "");
    EXPECT_EQ(occurrences(html, "<script"), 1U);
    EXPECT_EQ(occurrences(html, "</script"), 1U);
    EXPECT_EQ(figures_in(html).size(), 1U);
    EXPECT_LT(html.size(), evil.size() + 4'000U);
  }
}

}  // namespace
}  // namespace kelpie::figure_test
