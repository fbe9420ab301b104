// SPDX-License-Identifier: Apache-2.0
#include "core/text.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kelpie::text_test {
namespace {

TEST(Text, NumbersAreReadWholeOrNotAtAll) {
  double value = 0.0;
  EXPECT_TRUE(parse_number("-1.5e-3", value));
  EXPECT_EQ(value, -1.5e-3);
  EXPECT_TRUE(parse_number("+2", value));
  EXPECT_EQ(value, 2.0);
  EXPECT_TRUE(parse_number("nan", value));
  EXPECT_TRUE(std::isnan(value));
  EXPECT_TRUE(parse_number("-inf", value));
  EXPECT_TRUE(std::isinf(value));
  for (const char* const text : {"", "+", "+-1", "1.5x", "1 2", "1,5", "0x10", "--1", "1e", " 1"}) {
    EXPECT_FALSE(parse_number(text, value)) << text;
  }
}

TEST(Text, SplitKeepsEmptyParts) {
  EXPECT_EQ(split_text(" a ,, b", ','), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_EQ(split_text("", ','), (std::vector<std::string>{""}));
  EXPECT_EQ(split_text("a,", ','), (std::vector<std::string>{"a", ""}));
}

TEST(Text, JoinKeepsEmptyParts) {
  const std::string text = ",x,";
  EXPECT_EQ(join_text(split_text(text, ','), ","), text);
}

TEST(Text, ALongTextIsShortenedOnce) {
  EXPECT_EQ(shortened("abcdef", 6), "abcdef");
  EXPECT_EQ(shortened("abcdefg", 6), "abc … efg");
  EXPECT_EQ(shortened("aaéaaaaéaa", 6), "aa … aa");  // no half letters
  const std::string once = shortened(std::string(5'000, 'a') + std::string(5'000, 'b'));
  EXPECT_EQ(shortened(once), once);
}

TEST(Text, SuggestsOnlyWhatIsNear) {
  const std::vector<std::string> names{"gamma", "epsilon", "buffer"};
  EXPECT_EQ(did_you_mean("gama", names), " (did you mean 'gamma'?)");
  EXPECT_EQ(did_you_mean("Epsilon", names), " (did you mean 'epsilon'?)");
  EXPECT_EQ(did_you_mean("bufer_size", names), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
}

TEST(Text, ShowsOfOthersOneShortPrintableLine) {
  struct Case {
    std::string text;
    std::string shown;
  };
  const std::vector<Case> cases{
      {"/odom", "/odom"},
      {"tiefe ü, 深さ, 🐟", "tiefe ü, 深さ, 🐟"},
      {"a\nb\r\tc\x1b[2J\x7f", "a?b??c?[2J?"},
      {std::string("a\0b", 3), "a?b"},
      {"\xc2\x9b|\xe2\x80\xa8|\xe2\x80\xae",
       "??|???|???"},                              // 1-letter CSI, end of line, right to left
      {"a\u061Cb\u200Ec\u200Fd", "a??b???c???d"},  // marks of the direction
      {"\xff|\x80|\xc3|\xe2\x82", "?|?|?|??"},
      {"\xc0\xaf|\xed\xa0\x80|\xf4\x90\x80\x80", "??|???|????"},  // too long, half, too far
      {std::string(80, 'x'), std::string(80, 'x')},
      {std::string(20'000, 'x'), std::string(80, 'x') + "…"},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(printable(one.text), one.shown);
  }
  EXPECT_EQ(printable("üüü", 2), "üü…");  // not in the middle of a letter
}

TEST(Text, EditDistanceIsAMetricOnKnownPairs) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", "abc"), 0U);
}

}  // namespace
}  // namespace kelpie::text_test
