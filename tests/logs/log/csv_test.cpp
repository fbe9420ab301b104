// SPDX-License-Identifier: Apache-2.0
#include "log/dataset.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string_view>

#include "kelpie/core/error.hpp"
#include "log/csv_text.hpp"
#include "support.hpp"

namespace kelpie::csv_test {
namespace {

using testing::csv_refusal;
using testing::data_file;
using testing::message_of;
using testing::parse_csv;
using testing::TemporaryFolder;
using Names = std::vector<std::string>;
using Column = std::vector<double>;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Csv, ReadsEverySeparatorLineEndAndDecoration) {
  for (const std::string text :
       {"u,v\n1,2\n3,4\n", "u;v\r\n1;2\r\n3;4\r\n", "u\tv\n1\t2\n3\t4", "u,v\r1,2\r3,4\r",
        "\xEF\xBB\xBFu, v\n1, 2\n3 ,+4\n", "# a log\n\nu,v\n # between\n1,2\n\n3,4\n\n",
        "\"u\",\"v\"\n\"1\",2\n 3 , \"4\" \n", "u,v\r\n1,2\r3,4\n"}) {
    const log::Table table = parse_csv(text);
    EXPECT_EQ(table.names, (Names{"u", "v"})) << text;
    EXPECT_EQ(table.columns, (std::vector<Column>{{1.0, 3.0}, {2.0, 4.0}})) << text;
  }
}

TEST(Csv, OneColumnNeedsNoSeparator) {
  const log::Table table = parse_csv("u\n1\n2\n");
  EXPECT_EQ(table.names, Names{"u"});
  EXPECT_EQ(table.columns, (std::vector<Column>{{1.0, 2.0}}));
}

TEST(Csv, SeparatorIsTheOneTheHeaderHoldsMostOfOutsideQuotes) {
  const log::Table table = parse_csv("\"speed, u, m/s\";\"the \"\"left\"\" one\"\n1;2\n");
  EXPECT_EQ(table.names, (Names{"speed, u, m/s", "the \"left\" one"}));
}

TEST(Csv, LineNumbersCountCommentsBlanksAndEveryLineEnd) {
  EXPECT_EQ(parse_csv("# one\nu\n\n# four\n5\n6\n").lines, (std::vector<std::size_t>{5, 6}));
  EXPECT_EQ(parse_csv("u\r\n\r\n3\r\n4").lines, (std::vector<std::size_t>{3, 4}));
  EXPECT_EQ(parse_csv("u\r\r3\r4").lines, (std::vector<std::size_t>{3, 4}));
}

TEST(Csv, EmptyAndInfiniteCellsAreNumbers) {
  const log::Table table = parse_csv("u,v\n,inf\nnan,-inf\n");
  EXPECT_TRUE(std::isnan(table.columns[0][0]));
  EXPECT_TRUE(std::isnan(table.columns[0][1]));
  EXPECT_EQ(table.columns[1], (Column{HUGE_VAL, -HUGE_VAL}));
  EXPECT_NO_THROW(table.require_numbers(0));
  EXPECT_NO_THROW(table.require_numbers(1));
}

TEST(Csv, WordsMatterOnlyToWhoUsesTheColumn) {
  const log::Table table = parse_csv("mode,u\nhover,1\ndive,2\n");
  EXPECT_EQ(table.columns[1], (Column{1.0, 2.0}));
  EXPECT_TRUE(std::isnan(table.columns[0][1]));
  EXPECT_FALSE(table.has_text(1));
  EXPECT_EQ(table.texts[0].line, 2U);
  EXPECT_EQ(table.texts[0].cell, "hover");
}

TEST(Csv, WordsAreWrittenAsTheyWereRead) {
  const log::Table table = parse_csv("a;n;b\n\"dive, 7\";1;x\n;2;7\nsays \"so\";;3.50m\n");
  const std::string text = log::csv_text(table);
  EXPECT_EQ(text, "a,n,b\n\"dive, 7\",1,x\nnan,2,7\n\"says \"\"so\"\"\",nan,3.50m\n");
  EXPECT_EQ(log::csv_text(parse_csv(text)), text);
}

TEST(Csv, NumbersOutOfRangeAreNotTakenForOthers) {
  const log::Table table = parse_csv("u\n1e400\n");
  EXPECT_TRUE(std::isnan(table.columns[0][0]));
  EXPECT_THROW(table.require_numbers(0), InputError);
}

TEST(Csv, ShownTextIsShortAndHarmless) {
  const log::Table words = parse_csv("u\n" + std::string(1000000, 'x') + "\n");
  EXPECT_EQ(words.texts[0].cell, std::string(40, 'x') + "…");
  EXPECT_EQ(parse_csv("u\n\x1B[31mred\n").texts[0].cell, "?[31mred");
  const std::string cut = parse_csv("u\n" + std::string(39, 'x') + "äöü\n").texts[0].cell;
  EXPECT_EQ(cut, std::string(39, 'x') + "ä…");  // not in the middle of a letter
}

TEST(Csv, RefusesWithPlaceAndReason) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "log.csv: is empty"},
      {"# only\n\n", "log.csv: is empty"},
      {"u,v\n# only\n", "log.csv: has a header but no rows"},
      {"1,2\n3,4\n", "log.csv:1: the first line holds only numbers"},
      {"#\nu,v,u\n1,2,3\n", "log.csv:2: u: two columns have this name"},
      {"u,,v\n1,2,3\n", "log.csv:1: column 2: has no name"},
      {"u,Stra\xDF"
       "e\n1,2\n",
       "log.csv:1: column 2: the column's name is not UTF-8"},
      {"u,v,\n1,2,\n", "log.csv:1: column 3: has no name"},
      {"u,v\n1,2\n\n1,2,3\n", "log.csv:4: 3 cells in this row; the header has 2"},
      {"u,v\n1\n", "log.csv:2: 1 cells in this row; the header has 2"},
      {"u,v\n1,\"2\n3,4\n", "log.csv:2: a quote is opened but not closed"},
      {"u,v\n1,\"2\" x\n", "log.csv:2: after a closing quote the next ',' is due"},
      {std::string("u,v\n1,2\n3,\0\n", 12), "log.csv:3: holds a NUL byte"},
      {"\xFF\xFEu", "log.csv: is UTF-16"},
      {std::string("\0u\0,", 4), "log.csv:1: holds a NUL byte"},
  };
  for (const auto& [text, start] : cases) {
    EXPECT_TRUE(csv_refusal(text).starts_with(start)) << csv_refusal(text) << "\nfor: " << text;
  }
}

TEST(Csv, RefusesWhatIsNoReadableFile) {
  const TemporaryFolder folder;
  EXPECT_TRUE(holds(message_of<InputError>([&] { log::read_csv(folder / "none.csv"); }),
                    "none.csv: cannot be read: No such file"));
  EXPECT_TRUE(holds(message_of<InputError>([&] { log::read_csv(folder.path()); }), "is a folder"));
}

TEST(Csv, ADeviceThatFailsIsNotTheInputsFault) {
  EXPECT_THROW(log::read_csv("/proc/self/mem"), Failure);  // nothing is mapped at its beginning
}

// Any bit pattern that is a number, so subnormals, -0.0 and both infinities as well.
Column any_numbers(std::size_t count) {
  Column column;
  while (column.size() < count) {
    const auto value = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
    const auto subnormal = std::bit_cast<double>(*rc::gen::inRange<std::uint64_t>(0, 1ULL << 52U));
    column.push_back(*rc::gen::element(value, subnormal, -subnormal, -0.0, HUGE_VAL));
  }
  return column;
}

bool is_same(double a, double b) {
  return std::isnan(a) ? std::isnan(b)
                       : std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

RC_GTEST_PROP(Csv, WhatIsWrittenReadsBackBitForBit, ()) {
  const TemporaryFolder folder;
  const auto rows = *rc::gen::inRange<std::size_t>(1, 30);
  const log::Table written{.source = {},
                           .names = {"u", "#v; \"w\"", " x,y\t"},
                           .columns = {any_numbers(rows), any_numbers(rows), any_numbers(rows)},
                           .lines = std::vector<std::size_t>(rows),
                           .texts = {}};
  log::write_csv(folder / "log.csv", written);
  const log::Table read = log::read_csv(folder / "log.csv");
  RC_ASSERT(read.names.size() == 3U);
  RC_ASSERT(read.names[1] == written.names[1]);
  RC_ASSERT(read.rows() == rows);
  for (std::size_t column = 0; column < 3; ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      RC_ASSERT(is_same(written.columns[column][row], read.columns[column][row]));
    }
  }
}

RC_GTEST_PROP(Csv, AnyBytesAreReadOrRefused, (const std::vector<std::uint8_t>& bytes)) {
  constexpr std::string_view kAlphabet{"u1,;\t\"#\r\n \\.e-\xEF\xBB\xBF\0", 18};
  std::string text = *rc::gen::element<std::string>("", "u,v\n1,2\n", "u\n");
  for (const std::uint8_t byte : bytes) {
    text += byte < 200 ? kAlphabet[byte % kAlphabet.size()] : static_cast<char>(byte);
  }
  try {
    const log::Table table = parse_csv(text);
    RC_CLASSIFY(true, "read");
    RC_ASSERT(table.rows() > 0U);
    RC_ASSERT(table.columns.size() == table.names.size());
    for (const Column& column : table.columns) {
      RC_ASSERT(column.size() == table.rows());
    }
  } catch (const InputError& error) {
    RC_ASSERT(error.place().file == "log.csv");
  }
}

TEST(Csv, UnitsInAHeaderAreThoseOfTheOption) {
  for (const std::string unit : {"knots", "knot", "kn", "kt", "kts", "deg/sec", "m/sec", "dps",
                                 "degrees", "deg", "mrad", "g", "RPM", "sec", "m/s", "°/s"}) {
    const log::Table table = parse_csv("t,u [" + unit + "],n (" + unit + ")\n0,1,2\n");
    EXPECT_EQ(table.names, (Names{"t", "u", "n"})) << unit;
    EXPECT_EQ(table.units, (Names{"", unit, unit}));
  }
  for (const std::string name : {"v[0]", "w [left]", "w [cm left]", "n (second)"}) {
    EXPECT_EQ(parse_csv(name + ",u\n0,1\n").names[0], name);
  }
  const log::Table timed = parse_csv("t [seconds],u\n0,1\n");
  EXPECT_EQ(timed.seconds_per_unit(0), 1.0);
  EXPECT_EQ(log::si_unit("log.csv", "r", "deg/sec"), log::si_unit("log.csv", "r", "dps"));
  EXPECT_EQ(log::si_unit("log.csv", "r", "m/sec"), log::si_unit("log.csv", "r", "m/s"));
}

TEST(Csv, ReadsTheRealLog) {
  const auto file = data_file("dagon_config1.csv");
  if (file.empty()) {
    GTEST_SKIP() << "dagon_config1.csv is absent; set KELPIE_DATA_DIR to its folder";
  }
  const log::Table table = log::read_csv(file);
  EXPECT_EQ(table.names, (Names{"u", "v", "r", "th1", "th2", "th3", "udot", "vdot", "rdot"}));
  EXPECT_EQ(table.rows(), 11567U);
  EXPECT_EQ(table.lines.back(), 11568U);
  EXPECT_EQ(table.columns[0][0], 0.018734009121);
  EXPECT_TRUE(std::signbit(table.columns[4][0]));  // "-0.0"
  EXPECT_EQ(table.columns[8].back(), -0.0279483014505);
}

}  // namespace
}  // namespace kelpie::csv_test
