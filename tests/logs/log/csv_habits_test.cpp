// SPDX-License-Identifier: Apache-2.0
// What pandas, spreadsheets and loggers make of a CSV file.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <sstream>

#include "kelpie/core/error.hpp"
#include "log/csv_text.hpp"
#include "log/csv_time.hpp"
#include "log/dataset.hpp"
#include "support.hpp"

namespace kelpie::csv_habits_test {
namespace {

using testing::csv_refusal;
using testing::message_of;
using testing::parse_csv;
using Names = std::vector<std::string>;
using Column = std::vector<double>;

// As pandas 1.5.3's to_csv() writes a frame of four rows 0.1 s apart, whose u is 0.5, -1.25,
// missing, 3e-7 and whose n counts: with an index of time stamps, in two zones and without one, by
// sep=";", decimal=",", and with an index of row numbers.
TEST(CsvHabits, FramesOfPandas) {
  const Names wanted{"time", "u", "n"};
  for (const std::string text :
       {",u,n\n2023-05-01 12:00:00+00:00,0.5,1\n2023-05-01 12:00:00.100000+00:00,-1.25,2\n"
        "2023-05-01 12:00:00.200000+00:00,,3\n2023-05-01 12:00:00.300000+00:00,3e-07,4\n",
        ",u,n\n2023-05-01 14:00:00+02:00,0.5,1\n2023-05-01 14:00:00.100000+02:00,-1.25,2\n"
        "2023-05-01 14:00:00.200000+02:00,,3\n2023-05-01 14:00:00.300000+02:00,3e-07,4\n",
        ";u;n\n2023-05-01 12:00:00;0,5;1\n2023-05-01 12:00:00.100000;-1,25;2\n"
        "2023-05-01 12:00:00.200000;;3\n2023-05-01 12:00:00.300000;3e-07;4\n"}) {
    const log::Table table = parse_csv(text);
    EXPECT_EQ(table.names, wanted) << text;
    EXPECT_EQ(table.columns[0], (Column{0.0, 0.1, 0.2, 0.3})) << text;
    EXPECT_EQ(table.columns[1][1], -1.25);
    EXPECT_TRUE(std::isnan(table.columns[1][2]));
    EXPECT_EQ(table.columns[1][3], 3e-7);
    EXPECT_TRUE(table.is_time(0));
    EXPECT_NO_THROW(table.require_numbers(0));
  }
  const log::Table numbered = parse_csv("\tu\tn\n0\t0.5\t1\n1\t-1.25\t2\n2\t\t3\n7\t3e-07\t4\n");
  EXPECT_EQ(numbered.names, (Names{"u", "n"}));
  EXPECT_EQ(numbered.columns[1], (Column{1, 2, 3, 4}));
}

TEST(CsvHabits, AFirstColumnWithoutANameIsARowNumberOrATime) {
  for (const std::string text : {",u\n0,1\n0,2\n", ",u\n0.5,1\n1,2\n", ",u\n2,1\n1,2\n",
                                 ",u\nx,1\ny,2\n", ",u\n,1\n,2\n", ",u\n-1,1\n0,2\n"}) {
    EXPECT_TRUE(csv_refusal(text).starts_with("log.csv:1: column 1: has no name")) << text;
  }
  EXPECT_EQ(parse_csv(",u,time\n2023-05-01,1,2\n2023-05-02,2,3\n").names,
            (Names{"time of the row", "u", "time"}));
}

TEST(CsvHabits, TimeStampsAreSecondsSinceTheFirst) {
  const std::vector<std::pair<std::string, std::int64_t>> stamps{
      {"1970-01-01", 0},
      {"1970-01-01T00:00:01Z", 1'000'000'000},
      {"1970-01-01 00:01", 60'000'000'000},
      {"1970-01-01 00:00:00.123456789", 123'456'789},
      {"1970-01-01 00:00:00,5", 500'000'000},
      {"1970-01-01 00:00:00.1234567899", 123'456'789},
      {"1970-01-01 02:00:00+02:00", 0},
      {"1970-01-01 02:00:00 +0200", 0},
      {"1969-12-31T22:30:00-01:30", -1},
      {"1970-01-01T00:00:00-01:30", 5'400'000'000'000},
      {"1970-01-01 01:00:00+01", 0},
      {"1970-01-01 00:00:00 UTC", 0},
      {"2024-02-29 23:59:60", 1'709'251'200'000'000'000},
      {"2023-05-01 12:00:00.123456+00:00", 1'682'942'400'123'456'000},
  };
  for (const auto& [text, time_ns] : stamps) {
    if (time_ns < 0) {
      EXPECT_FALSE(log::parse_stamp(text)) << text;
    } else {
      EXPECT_EQ(log::parse_stamp(text), time_ns) << text;
    }
  }
  for (const char* const text :
       {"", "2023", "2023-5-1", "2023-02-29", "2023-13-01", "2023-05-01 ", "2023-05-01 24:00:00",
        "2023-05-01 12", "2023-05-01 12:60", "2023-05-01 12:00:61", "2023-05-01 12:00:00.",
        "2023-05-01 12:00:00+2", "2023-05-01 12:00:00 CET", "2023-05-01 12:00:00Zx",
        "2023-05-01x12:00:00", "01.05.2023 12:00", "20230501T120000"}) {
    EXPECT_FALSE(log::parse_stamp(text)) << text;
  }
}

TEST(CsvHabits, TimeStampsAreTakenForTheTime) {
  const log::Table table = parse_csv(
      "received,u,udot,noted\n2023-05-01 12:00:00,1,2,2023-05-02\n2023-05-01 12:00:00.5,2,3,\n"
      "2023-05-01 12:00:01,4,7,2023-05-03\n");
  const log::Roles roles = log::guess_roles(table, {});
  EXPECT_EQ(roles.time, "received");
  EXPECT_EQ(roles.inputs, Names{"u"});
  const log::Dataset data = log::make_dataset(table, roles);
  EXPECT_EQ(data.times_s, (Column{0.0, 0.5, 1.0}));
  EXPECT_EQ(data.rate_hz, 2.0);
}

TEST(CsvHabits, AStampThatIsNoneIsNamedWithItsLine) {
  const log::Table table =
      parse_csv("t,u\n2023-05-01 12:00:00,1\n\n2023-05-01 12:60:00,2\n2023-05-01 12:02:00,3\n");
  EXPECT_TRUE(message_of<InputError>([&] {
                table.require_numbers(0);
              }).starts_with("log.csv:4: t: '2023-05-01 12:60:00' is not a number"));
}

TEST(CsvHabits, DayOrMonthFirstIsNotGuessed) {
  for (const std::string stamp : {"01.05.2023 12:00", "5/1/2023 12:00:00", "1/5/23", "1-5-2023"}) {
    const log::Table table = parse_csv("when,u,udot\n" + stamp + ",1,2\n" + stamp + ",2,3\n");
    EXPECT_NE(message_of<InputError>([&] {
                table.require_numbers(0);
              }).find("log.csv:2: when: '" + stamp + "' may have the day or the month first"),
              std::string::npos);
    EXPECT_NE(message_of<InputError>([&] {
                log::make_dataset(table, log::guess_roles(table, {}));
              }).find("when holds '" + stamp + "', which may have the day or the month first"),
              std::string::npos);
  }
}

TEST(CsvHabits, DecimalCommasWhereCommasSeparateNothing) {
  EXPECT_EQ(parse_csv("u;v\n0,5;-1,25e2\n1;,5\n").columns,
            (std::vector<Column>{{0.5, 1}, {-125, 0.5}}));
  EXPECT_EQ(parse_csv("u\tv\n0,5\t1\n").columns[0], Column{0.5});
  EXPECT_EQ(parse_csv("u;v\n1.234,5;1\n").texts[0].cell, "1.234,5");
  EXPECT_EQ(csv_refusal("u;v\n0,5;1\n1;2.5\n"),
            "log.csv:3: v: '2.5': decimals have a comma on line 2 and a point on line 3; write all "
            "of them alike, and nothing between thousands");
  EXPECT_TRUE(csv_refusal("u;v\n0.5;1\n1;12,345\n").starts_with("log.csv:3: v: '12,345'"));
  EXPECT_EQ(parse_csv("u,v\n\"0,5\",1\n").texts[0].cell, "0,5");  // where they do, a word
}

TEST(CsvHabits, ASpreadsheetNamesItsSeparator) {
  const log::Table table = parse_csv("\xEF\xBB\xBFsep=;\r\nu,x;v\r\n0,5;1\r\n");
  EXPECT_EQ(table.names, (Names{"u,x", "v"}));
  EXPECT_EQ(table.lines, std::vector<std::size_t>{3});
}

TEST(CsvHabits, UnitsInTheHeader) {
  const log::Table table = parse_csv(
      "t [ms],u [m/s],udot (m/s^2),n[rpm],q [-],v[0],w [left],x[m],x[s]\n"
      "0,1,2,3,4,5,6,7,8\n500,2,1,3,4,5,6,7,8\n");
  EXPECT_EQ(table.names, (Names{"t", "u", "udot", "n", "q", "v[0]", "w [left]", "x[m]", "x[s]"}));
  EXPECT_EQ(table.units, (Names{"ms", "m/s", "m/s^2", "rpm", "1", "", "", "", ""}));
  const log::Dataset data =
      log::make_dataset(table, {.inputs = {"u"}, .targets = {"udot"}, .time = "t"});
  EXPECT_EQ(data.times_s, (Column{0.0, 0.5}));
  EXPECT_EQ(data.units.at("udot"), Unit::parse("m/s^2"));
  EXPECT_EQ(message_of<InputError>([&] {
              log::make_dataset(table, {.inputs = {"u"}, .targets = {"udot"}, .time = "n"});
            }),
            "log.csv: n: is in rpm, which is not a unit of time; use s or ms");
}

TEST(CsvHabits, ARowOfUnits) {
  const log::Table table = parse_csv("t,u,mode,q\ns,m/s,,-\n0,1,dive,2\n");
  EXPECT_EQ(table.rows(), 1U);
  EXPECT_EQ(table.units, (Names{"s", "m/s", "", "1"}));
  EXPECT_EQ(parse_csv("mode,who\nhover,me\n").rows(), 1U);  // words, but no units
  EXPECT_EQ(parse_csv("u,v\n,\n1,2\n").rows(), 2U);
}

TEST(CsvHabits, PackedByGzip) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "log.csv").string();
  gzFile_s* const packed = ::gzopen(file.c_str(), "wb");
  ::gzputs(packed, "u,v\n1,2\n3,4\n");
  ::gzclose(packed);
  EXPECT_EQ(log::read_csv(file).columns, (std::vector<Column>{{1, 3}, {2, 4}}));
}

}  // namespace
}  // namespace kelpie::csv_habits_test
