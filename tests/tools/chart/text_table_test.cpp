// SPDX-License-Identifier: Apache-2.0
#include "chart/text_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "chart/wording.hpp"
#include "core/text.hpp"

namespace kelpie::text_table_test {
namespace {

TEST(TextTable, WordsBeginAndNumbersEndAtOnePlace) {
  const chart::TextTable table{.title = "T",
                               .head = {"axis", "R²\nfinal", "found"},
                               .rows = {{"ṙ", "−0.2", ""}, {"udot", "10", "a gap"}},
                               .notes = {"said below"},
                               .left = {0, 2}};
  EXPECT_EQ(chart::table_text(table),
            "T\n"
            "           R²\n"
            "  axis  final  found\n"
            "  ṙ      −0.2\n"
            "  udot     10  a gap\n"
            "said below\n"
            "\n");
}

TEST(TextTable, WordsAreCutBeforeALineGetsWiderThanTheTerminalNumbersAreNot) {
  chart::TextTable table{{}, {}, {{std::string(60, 'n')}, {std::string(60, 'm')}}};
  for (int i = 0; i < 8; ++i) {
    table.rows[0].emplace_back("123456789");
  }
  for (const std::string& line : split_text(chart::table_text(table), '\n')) {
    EXPECT_LE(chart::code_points(line), 100U) << line;
  }
  EXPECT_NE(chart::table_text(table).find("n… 123456789 "), std::string::npos);
  table.whole = true;
  EXPECT_NE(chart::table_text(table).find(std::string(60, 'n') + "  123456789"), std::string::npos);
}

// A byte that continues nothing counts for no letter, but is shown as one.
TEST(TextTable, BrokenUtf8IsAsWideAsItIsShown) {
  EXPECT_EQ(chart::table_text({{}, {}, {{"\x80"}, {""}}}), "  \xEF\xBF\xBD\n\n\n");
}

}  // namespace
}  // namespace kelpie::text_table_test
