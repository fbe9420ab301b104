// SPDX-License-Identifier: Apache-2.0
#include "chart/wording.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace kelpie::wording_test {
namespace {

TEST(Printable, LeavesNothingThatTurnsTheDirectionOfWhatIsBeside) {
  // NOLINTNEXTLINE(misc-misleading-bidirectional)
  EXPECT_EQ(chart::safe_text("a\u202eb\u2066c\u200f\u061cd"), "a\uFFFDb\uFFFDc\uFFFD\uFFFDd");
  EXPECT_EQ(chart::safe_text("שלום – … ’"), "שלום – … ’");
}

TEST(Wording, ControlCharactersAndBrokenUtf8CannotReachATerminal) {
  EXPECT_EQ(chart::safe_text("a\x1b[2Jb"), "a\uFFFD[2Jb");
  EXPECT_EQ(chart::safe_text("x\xffy"), "x\uFFFDy");
  EXPECT_EQ(chart::safe_text("a\u009B2Jb\u00A0"), "a\uFFFD2Jb\u00A0");
  EXPECT_EQ(chart::safe_text("Ω̇ ünï"), "Ω̇ ünï");
}

RC_GTEST_PROP(Wording, EscapedTextHoldsNoMarkup, (const std::string& text)) {
  const std::string escaped = chart::escape_markup(text);
  RC_ASSERT(escaped.find_first_of("<>\"'") == std::string::npos);
}

TEST(Wording, CutsBetweenCodePoints) {
  EXPECT_EQ(chart::shortened("ṙẇṗq", 4), "ṙẇṗq");
  EXPECT_EQ(chart::shortened("ṙẇṗq", 3), "ṙẇ…");
  EXPECT_EQ(chart::shortened("ṙẇṗq", 1), "…");
}

TEST(Wording, FilesAreNamedWithoutTheirFolders) {
  EXPECT_EQ(chart::file_names("dives/a.csv"), "a.csv");
  EXPECT_EQ(chart::file_names("dives/a.csv, b.csv, /c/d.csv"), "a.csv, b.csv, d.csv");
  EXPECT_EQ(chart::file_names("mission/"), "mission");
  EXPECT_EQ(chart::file_names("../missions/first//"), "first");
  EXPECT_EQ(chart::file_names("/"), "/");
  EXPECT_EQ(chart::file_names(""), "");
}

TEST(Wording, UnitsReadAsPeopleWriteThem) {
  EXPECT_EQ(chart::unit_text("m s^-2"), "m/s²");
  EXPECT_EQ(chart::unit_text("s^-1"), "1/s");
  EXPECT_EQ(chart::unit_text("N m^2 rad^-1 s^-1"), "N·m²/(rad·s)");
  EXPECT_EQ(chart::unit_text("m^2/(rad s)"), "m²/(rad s)");
  EXPECT_EQ(chart::unit_text("N/(rev s^-1)^2"), "N/(rev/s)²");
  EXPECT_EQ(chart::unit_text("m^0.5"), "m^0.5");
  EXPECT_EQ(chart::unit_text("m s^-12"), "m s^-12");
  EXPECT_EQ(chart::unit_text("1"), "1");
  EXPECT_EQ(chart::unit_text(""), "");
}

RC_GTEST_PROP(Wording, NoUnitEndsIt, (const std::string& text)) {
  chart::unit_text(text);
}

TEST(Wording, ListsReadWell) {
  EXPECT_EQ(chart::list_text({}), "");
  EXPECT_EQ(chart::list_text({"a"}), "a");
  EXPECT_EQ(chart::list_text({"a", "b", "c"}), "a, b and c");
}

TEST(Wording, NumbersReadWell) {
  EXPECT_EQ(chart::grouped(0), "0");
  EXPECT_EQ(chart::grouped(999), "999");
  EXPECT_EQ(chart::grouped(-1234567), "−1,234,567");
  EXPECT_EQ(chart::decimal(0.9514), "0.951");
  EXPECT_EQ(chart::decimal(-0.2041), "−0.204");
  EXPECT_EQ(chart::decimal(-0.0001), "0.000");
  EXPECT_EQ(chart::decimal(-1.5e8), "−1.5e+08");
  EXPECT_EQ(chart::decimal(NAN), "–");
}

TEST(Wording, TimesKeepTheirDigitsWhateverTheirOrigin) {
  EXPECT_EQ(chart::time_text(0.0), "0");
  EXPECT_EQ(chart::time_text(862.5), "862.5");
  EXPECT_EQ(chart::time_text(1700001273.75), "1700001273.75");
  EXPECT_EQ(chart::time_text(-20.0), "-20");
  EXPECT_EQ(chart::time_text(NAN), "–");
}

TEST(Wording, DurationsTakeTheUnitThatSuitsThem) {
  EXPECT_EQ(chart::duration(0.0), "0.0 µs");
  EXPECT_EQ(chart::duration(301.4), "301 µs");
  EXPECT_EQ(chart::duration(999.7), "1.0 ms");
  EXPECT_EQ(chart::duration(3812.0), "3.8 ms");
  EXPECT_EQ(chart::duration(1.2e6), "1.2 s");
  EXPECT_EQ(chart::duration(NAN), "–");
}

}  // namespace
}  // namespace kelpie::wording_test
