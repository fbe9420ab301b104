// SPDX-License-Identifier: Apache-2.0
#include "chart/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "chart/markup_check.hpp"

namespace kelpie::figure_test {
namespace {

chart::Figure figure(chart::Extent x, chart::Extent y) {
  return {{400, 250}, {"x in s", x}, {"y", y}, "a figure"};
}

TEST(Figure, IsWellFormedWithHostileText) {
  chart::Figure drawing({400, 250}, {"<b>&\"x\"", {}}, {"'y' >", {}},
                        "\"><script>alert(1)</script>");
  drawing.line(std::vector<chart::Point>{{0, 0}, {1, 1}}, 0, "</svg><script>");
  drawing.mark(0.5, "<i>");
  const std::string svg = drawing.svg();
  EXPECT_EQ(take_apart(svg).fault, "");
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_EQ(occurrences(svg, "</svg>"), 1U);
}

TEST(Figure, DrawsFiniteNumbersOnlyAndBreaksLinesAtOthers) {
  const double inf = std::numeric_limits<double>::infinity();
  chart::Figure drawing = figure({0, 9}, {-1, 1});
  drawing.line(
      std::vector<chart::Point>{{0, 0}, {1, 1}, {2, NAN}, {3, inf}, {NAN, 0}, {5, 0}, {6, 1}}, 0,
      "");
  drawing.dots(std::vector<chart::Point>{{NAN, NAN}, {-inf, inf}}, 1, "");
  drawing.boxes(std::vector<chart::Box>{{0, 1, 0, NAN}, {NAN, 1, 0, 1}}, 1, "");
  drawing.mark(NAN, "nowhere");
  const std::string svg = drawing.svg();
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.find("nowhere"), std::string::npos);
  ASSERT_EQ(of_class(svg, "line").size(), 1U);
  EXPECT_EQ(occurrences(of_class(svg, "line")[0]["d"], "M"), 2U);
}

TEST(Figure, ABandIsLeftOutWhereEitherEdgeBreaks) {
  chart::Figure drawing = figure({0, 4}, {0, 1});
  const std::vector<chart::Point> low{{0, 0.1}, {1, 0.1}, {2, NAN}, {3, 0.1}, {4, 0.1}};
  const std::vector<chart::Point> high{{0, 0.9}, {1, 0.9}, {2, 0.9}, {3, 0.9}, {4, INFINITY}};
  drawing.band(low, high, 2);
  const std::string svg = drawing.svg();
  EXPECT_EQ(take_apart(svg).fault, "");
  ASSERT_EQ(of_class(svg, "band").size(), 1U);
  EXPECT_EQ(occurrences(of_class(svg, "band")[0]["d"], "z"), 1U);  // from 0 to 1 alone
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Figure, StaysInsideItsFrame) {
  chart::Figure drawing = figure({0, 1}, {0, 1});
  drawing.dots(std::vector<chart::Point>{{-1e300, 1e300}, {1e300, -1e300}}, 0, "");
  const std::string svg = drawing.svg();
  ASSERT_EQ(of_class(svg, "dot").size(), 1U);
  std::istringstream path(of_class(svg, "dot")[0]["d"]);
  char move = 0;
  int dots = 0;
  for (double x = 0.0, y = 0.0; path >> move >> x >> y; path.ignore(2)) {
    ++dots;
    EXPECT_GE(x, 20.0);
    EXPECT_LE(x, 400.0);
    EXPECT_GE(y, 0.0);
    EXPECT_LE(y, 250.0);
  }
  EXPECT_EQ(dots, 2);
}

TEST(Figure, OfAConstantOrAbsentSeriesStillHasAxes) {
  chart::Figure constant = figure({5, 5}, {0.3, 0.3});
  constant.line(std::vector<chart::Point>{{5, 0.3}}, 0, "one point");
  EXPECT_NE(constant.svg().find("class=\"marker s0\""), std::string::npos);
  EXPECT_EQ(constant.svg().find("no data"), std::string::npos);
  chart::Figure empty = figure({}, {});
  empty.line({}, 0, "nothing");
  EXPECT_NE(empty.svg().find(">no data</text>"), std::string::npos);
  EXPECT_EQ(take_apart(empty.svg()).fault, "");
}

TEST(Figure, SevenLinesDifferInColourAndDashAndSevenMoreInThePair) {
  std::set<std::string> looks;
  for (std::size_t style = 0; style < 14; ++style) {
    chart::Figure drawing = figure({}, {});
    drawing.line(std::vector<chart::Point>{{0, 0}, {1, 1}}, style, "");
    looks.insert(of_class(drawing.svg(), "line")[0]["class"]);
  }
  EXPECT_EQ(looks.size(), 14U);
}

// Texts centred on one height must not overlap, by a cautious guess of their width.
void expect_room_between(const std::vector<Element>& texts) {
  std::map<std::string, double> end_of_row;
  for (const Element& text : texts) {
    const double half = 3.2 * static_cast<double>(text.text.size());
    const double x = std::stod(text["x"]);
    const auto [row, first] = end_of_row.try_emplace(text["y"], 0.0);
    EXPECT_GE(x - half, row->second) << text.text;
    row->second = x + half;
    EXPECT_LE(row->second, 400.0) << text.text;
  }
}

std::vector<Element> centred(const std::string& svg, const std::string& start) {
  std::vector<Element> found;
  for (const Element& element : of_class(svg, "tick")) {
    if (element["text-anchor"] == "middle" && element.text.starts_with(start)) {
      found.push_back(element);
    }
  }
  return found;
}

TEST(Figure, LabelsOfMarksNeverOverlap) {
  chart::Figure drawing = figure({0, 100}, {0, 1});
  drawing.line(std::vector<chart::Point>{{0, 0}, {1, 1}}, 0, "");
  for (int i = 0; i <= 100; i += 4) {
    drawing.mark(i, "mark " + std::to_string(i));
  }
  const std::vector<Element> labels = centred(drawing.svg(), "mark");
  EXPECT_GE(labels.size(), 8U);
  expect_room_between(labels);
}

TEST(Figure, TickLabelsHaveRoomSideBySide) {
  for (const chart::Extent x :
       {chart::Extent{1.7e9, 1.7e9 + 60}, chart::Extent{0, 1}, chart::Extent{-1e-9, 1e-9}}) {
    chart::Figure drawing = figure(x, {0, 1});
    drawing.line(std::vector<chart::Point>{{x.low, 0}, {x.high, 1}}, 0, "");
    EXPECT_GE(centred(drawing.svg(), "").size(), 1U);
    expect_room_between(centred(drawing.svg(), ""));
  }
}

TEST(FigureStyle, CoversEveryClassTheSeriesUse) {
  const std::string style = chart::figure_style();
  for (int i = 0; i < 7; ++i) {
    for (const std::string kind : {"s", "f", "d"}) {
      EXPECT_NE(style.find(".figure ." + kind + std::to_string(i) + " "), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace kelpie::figure_test
