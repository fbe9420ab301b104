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

TEST(Text, SuggestsOnlyWhatIsNear) {
  const std::vector<std::string> names{"gamma", "epsilon", "buffer"};
  EXPECT_EQ(did_you_mean("gama", names), " (did you mean 'gamma'?)");
  EXPECT_EQ(did_you_mean("Epsilon", names), " (did you mean 'epsilon'?)");
  EXPECT_EQ(did_you_mean("bufer_size", names), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
}

TEST(Text, EditDistanceIsAMetricOnKnownPairs) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", "abc"), 0U);
}

}  // namespace
}  // namespace kelpie::text_test
