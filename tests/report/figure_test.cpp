// SPDX-License-Identifier: Apache-2.0
#include "kelpie/report/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <set>

#include "markup_check.hpp"

namespace kelpie {
namespace {

Figure figure(Range x, Range y) {
  return {{400, 250}, {"x in s", x}, {"y", y}, "a figure"};
}

TEST(Figure, IsWellFormedWithHostileText) {
  Figure drawing({400, 250}, {"<b>&\"x\"", {}}, {"'y' >", {}}, "\"><script>alert(1)</script>");
  drawing.line(std::vector<Point>{{0, 0}, {1, 1}}, 0, "</svg><script>");
  drawing.mark(0.5, "<i>");
  const std::string svg = drawing.svg();
  EXPECT_EQ(markup_fault(svg), "");
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_EQ(occurrences(svg, "</svg>"), 1U);
}

TEST(Figure, DrawsFiniteNumbersOnlyAndBreaksLinesAtOthers) {
  const double inf = std::numeric_limits<double>::infinity();
  Figure drawing = figure({0, 9}, {-1, 1});
  drawing.line(std::vector<Point>{{0, 0}, {1, 1}, {2, NAN}, {3, inf}, {NAN, 0}, {5, 0}, {6, 1}}, 0,
               "");
  drawing.dots(std::vector<Point>{{NAN, NAN}, {-inf, inf}}, 1, "");
  drawing.boxes(std::vector<Box>{{0, 1, 0, NAN}, {NAN, 1, 0, 1}}, 1, "");
  drawing.mark(NAN, "nowhere");
  const std::string svg = drawing.svg();
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.find("nowhere"), std::string::npos);
  std::smatch line;
  ASSERT_TRUE(std::regex_search(svg, line, std::regex("class=\"line[^\"]*\" d=\"([^\"]*)\"")));
  EXPECT_EQ(occurrences(line[1], "M"), 2U);
}

TEST(Figure, StaysInsideItsFrame) {
  Figure drawing = figure({0, 1}, {0, 1});
  drawing.dots(std::vector<Point>{{-1e300, 1e300}, {1e300, -1e300}}, 0, "");
  const std::string svg = drawing.svg();
  std::smatch dots;
  ASSERT_TRUE(std::regex_search(svg, dots,
                                std::regex("d=\"M([0-9.]+) ([0-9.]+)h0M([0-9.]+) ([0-9.]+)h0\"")));
  for (std::size_t i = 1; i <= 4; ++i) {
    EXPECT_GE(std::stod(dots[i]), 0.0);
    EXPECT_LE(std::stod(dots[i]), 400.0);
  }
}

TEST(Figure, OfAConstantOrAbsentSeriesStillHasAxes) {
  Figure constant = figure({5, 5}, {0.3, 0.3});
  constant.line(std::vector<Point>{{5, 0.3}}, 0, "one point");
  EXPECT_NE(constant.svg().find("class=\"marker s0\""), std::string::npos);
  EXPECT_EQ(constant.svg().find("no data"), std::string::npos);
  Figure empty = figure({}, {});
  empty.line({}, 0, "nothing");
  EXPECT_NE(empty.svg().find(">no data</text>"), std::string::npos);
  EXPECT_EQ(markup_fault(empty.svg()), "");
}

TEST(Figure, SevenLinesDifferInColourAndDashAndSevenMoreInThePair) {
  std::set<std::string> looks;
  for (std::size_t style = 0; style < 14; ++style) {
    Figure drawing = figure({}, {});
    drawing.line(std::vector<Point>{{0, 0}, {1, 1}}, style, "");
    for (const std::string& name : attributes(drawing.svg(), "class")) {
      if (name.starts_with("line ")) {
        looks.insert(name);
      }
    }
  }
  EXPECT_EQ(looks.size(), 14U);
}

// Text boxes of the labels above the plot, as (row, left, right), from the estimate of their width.
TEST(Figure, LabelsOfMarksNeverOverlap) {
  Figure drawing = figure({0, 100}, {0, 1});
  for (int i = 0; i < 30; ++i) {
    drawing.mark(i, "mark " + std::to_string(i));
  }
  const std::string svg = drawing.svg();
  const std::regex label(R"re(x="([0-9.]+)" y="([0-9.]+)">mark)re");
  std::map<std::string, double> last;
  std::size_t count = 0;
  for (std::sregex_iterator it(svg.begin(), svg.end(), label), end; it != end; ++it, ++count) {
    const double x = std::stod((*it)[1]);
    const auto [place, first] = last.try_emplace((*it)[2], x);
    EXPECT_TRUE(first || x - place->second > 7 * 6.0) << (*it)[0];
    place->second = x;
  }
  EXPECT_GE(count, 4U);
  EXPECT_EQ(last.size(), 2U);
}

TEST(Figure, TickLabelsHaveRoomSideBySide) {
  const std::string svg = figure({1.7e9, 1.7e9 + 60}, {0, 1}).svg();
  const std::regex label(R"re(text-anchor="middle" x="([0-9.]+)" y="226">([^<]+)<)re");
  double end_of_last = -1.0;
  std::size_t count = 0;
  for (std::sregex_iterator it(svg.begin(), svg.end(), label), end; it != end; ++it, ++count) {
    const double half = 3.2 * static_cast<double>((*it)[2].length());
    EXPECT_GT(std::stod((*it)[1]) - half, end_of_last);
    end_of_last = std::stod((*it)[1]) + half;
  }
  EXPECT_GE(count, 1U);
  EXPECT_LE(end_of_last, 400.0);
}

TEST(FigureStyle, CoversEveryClassTheSeriesUse) {
  const std::string style = figure_style();
  for (int i = 0; i < 7; ++i) {
    for (const std::string kind : {"s", "f", "d"}) {
      EXPECT_NE(style.find(".figure ." + kind + std::to_string(i) + " "), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace kelpie
