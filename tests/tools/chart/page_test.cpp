// SPDX-License-Identifier: Apache-2.0
#include "chart/page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "chart/markup_check.hpp"
#include "chart/page_assets.hpp"

namespace kelpie::page_test {
namespace {

const std::string kStyle(chart::kPageStyle);

// Of "#rrggbb", as WCAG 2 defines it.
double luminance(const std::string& colour) {
  double sum = 0.0;
  constexpr std::array weights{0.2126, 0.7152, 0.0722};
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = std::stoi(colour.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
    sum += weights[i] * (share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4));
  }
  return sum;
}

double contrast(const std::string& a, const std::string& b) {
  const auto [dark, light] = std::minmax({luminance(a), luminance(b)});
  return (light + 0.05) / (dark + 0.05);
}

TEST(Page, TextAndSeriesHaveAContrastOfFourAndAHalfOnWhiteAndOnBlack) {
  const std::size_t dark = kStyle.find("prefers-color-scheme: dark");
  ASSERT_NE(dark, std::string::npos);
  for (const std::string& theme : {kStyle.substr(0, dark), kStyle.substr(dark, 600)}) {
    const auto colour = [&](const std::string& name) {
      std::smatch found;
      EXPECT_TRUE(std::regex_search(theme, found, std::regex("--" + name + ": (#[0-9a-f]{6})")))
          << name;
      return found[1].str();
    };
    for (const char* const name :
         {"ink", "faint", "bad", "s0", "s1", "s2", "s3", "s4", "s5", "s6"}) {
      EXPECT_GE(contrast(colour(name), colour("paper")), 4.5) << name;
    }
    EXPECT_GE(contrast(colour("ink"), colour("warn")), 4.5);
  }
}

TEST(Page, LoadsNothingAndIsKeptFromIt) {
  const std::string page = chart::html_page("a title", "", {{"first", "<p>text</p>"}});
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(take_apart(page).fault, "");
  for (const char* const part : {" src=", "<link", "<img", "@import", "url("}) {
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  }
}

TEST(Page, HasALinkToEverySectionThatHoldsSomething) {
  const std::string page =
      chart::html_page("t", "", {{"<first>", "<p>x</p>"}, {"none", ""}, {"last", "<p>y</p>"}});
  EXPECT_EQ(occurrences(page, "<a href=\"#s"), 2U);
  EXPECT_NE(page.find("<a href=\"#s0\">&lt;first&gt;</a>"), std::string::npos);
  EXPECT_NE(page.find("<section id=\"s2\">"), std::string::npos);
  EXPECT_EQ(page.find("none</"), std::string::npos);
}

TEST(Page, FoldedSectionsComeWithOneLinkForAllOfThem) {
  const std::string page = chart::html_page(
      "t", "", {{"first", "<p>x</p>"}, {"<one>", "<p>y</p>", true}, {"two", "<p>z</p>", true}});
  EXPECT_EQ(take_apart(page).fault, "");
  EXPECT_EQ(occurrences(page, "<a href=\"#s"), 2U);
  EXPECT_NE(page.find("<a href=\"#s1\">Details</a>"), std::string::npos);
  EXPECT_NE(page.find("<summary>&lt;one&gt;</summary>"), std::string::npos);
}

TEST(Page, CommandsAndIntervalsAreEscaped) {
  const std::string html = chart::command_lines({{"kelpie <a>", "b&c"}}) +
                           chart::interval_table({{"<n>", 0.0, -1.0, 1.0, "0", "<note>"}});
  EXPECT_EQ(take_apart(html).fault, "");
  EXPECT_EQ(html.find("<n>"), std::string::npos);
  EXPECT_EQ(html.find("class=\"bar\""), std::string::npos) << "no scale without a value";
}

TEST(Page, HoldsTheLicenceOfTheLibraryThatDrawsItsFigures) {
  if (chart::kLibraryScript.empty()) {
    GTEST_SKIP() << "built without uPlot (scripts/setup.sh fetches it)";
  }
  const std::string page = chart::html_page("t", "", {});
  EXPECT_NE(page.find("The MIT License"), std::string::npos);
  EXPECT_NE(page.find("THE SOFTWARE IS PROVIDED"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::page_test
