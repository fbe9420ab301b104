// SPDX-License-Identifier: Apache-2.0
#include "kelpie/data/csv.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <vector>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie {
namespace {

using testing::message_of;
using testing::TemporaryFolder;

Table parse(const std::string& text) {
  std::istringstream stream(text);
  return read_csv(stream, "log.csv");
}

std::string refusal(const std::string& text) {
  return message_of<InputError>([&] { parse(text); });
}

TEST(Csv, ReadsEverySeparatorLineEndAndDecoration) {
  for (const std::string text :
       {"u,v\n1,2\n3,4\n", "u;v\r\n1;2\r\n3;4\r\n", "u\tv\n1\t2\n3\t4",
        "\xEF\xBB\xBFu, v\n1, 2\n3 ,4\n", "# a log\n\nu,v\n# in between\n1,2\n\n3,4\n",
        "\"u\",\"v\"\n\"1\",2\n3,\"4\"\n", "u,v\r1,2\r3,4\r"}) {
    const Table table = parse(text);
    EXPECT_EQ(table.names, (std::vector<std::string>{"u", "v"})) << text;
    EXPECT_EQ(table.columns, (std::vector<std::vector<double>>{{1.0, 3.0}, {2.0, 4.0}})) << text;
  }
}

TEST(Csv, QuotedNamesMayHoldSeparatorsAndQuotes) {
  const Table table = parse("\"speed, m/s\",\"the \"\"left\"\" one\"\n1,2\n");
  EXPECT_EQ(table.names, (std::vector<std::string>{"speed, m/s", "the \"left\" one"}));
}

TEST(Csv, LineNumbersCountEverything) {
  const Table table = parse("# one\nu\n\n# four\n5\n6\n");
  EXPECT_EQ(table.lines, (std::vector<std::size_t>{5, 6}));
}

TEST(Csv, EmptyAndSpecialCellsAreKeptForWhoUsesTheColumn) {
  const Table table = parse("u,v\n,inf\nnan,-inf\n");
  EXPECT_TRUE(std::isnan(table.columns[0][0]));
  EXPECT_TRUE(std::isnan(table.columns[0][1]));
  EXPECT_EQ(table.columns[1][0], HUGE_VAL);
  EXPECT_NO_THROW(table.require_numbers(0));
}

TEST(Csv, WordsAreAnErrorOnlyWhereNumbersAreWanted) {
  const Table table = parse("u,mode\n1,survey\n2,docking\n");
  EXPECT_NO_THROW(table.require_numbers(0));
  EXPECT_EQ(message_of<InputError>([&] { table.require_numbers(1); }),
            "log.csv:2: mode: 'survey' is not a number");
  const Table comma = parse("u;v\n1,5;2\n");
  EXPECT_EQ(message_of<InputError>([&] { comma.require_numbers(0); }),
            "log.csv:2: u: '1,5' is not a number (decimals are separated by a point)");
  EXPECT_NE(message_of<InputError>([&] { parse("u\n1e400\n").require_numbers(0); }), "");
}

TEST(Csv, RefusesWhatIsNoTable) {
  EXPECT_EQ(refusal(""),
            "log.csv: is empty; a header line with the names of the columns is needed");
  EXPECT_EQ(refusal("# nothing\n\n"),
            "log.csv: is empty; a header line with the names of the columns is needed");
  EXPECT_EQ(refusal("u,v\n"), "log.csv: has a header, but no rows");
  EXPECT_EQ(refusal("u,v\n1,2\n3\n"), "log.csv:3: 1 cells; the header has 2");
  EXPECT_EQ(refusal("u,v\n1,2,3\n"), "log.csv:2: 3 cells; the header has 2");
  EXPECT_EQ(refusal("u,v,u\n1,2,3\n"),
            "log.csv:1: u: there are two columns of this name; rename one");
  EXPECT_EQ(refusal("u,,w\n1,2,3\n"), "log.csv:1: column 2: has no name");
  EXPECT_EQ(refusal("1,2\n3,4\n"),
            "log.csv:1: header: there are only numbers; the first line has to name the columns");
  EXPECT_EQ(refusal("u,v\n\"1,2\n"),
            "log.csv:2: a quoted cell has to end with a quote before the next separator");
  EXPECT_EQ(refusal(std::string("u\0v\n1\n", 6)),
            "log.csv: is not plain text (UTF-16 or binary?); save it as UTF-8");
}

TEST(Csv, RefusesMissingFilesAndFolders) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of<InputError>([&] { read_csv(folder / "none.csv"); }),
            (folder / "none.csv").string() + ": there is no such file");
  EXPECT_EQ(message_of<InputError>([&] { read_csv(folder.path()); }),
            folder.path().string() + ": cannot be read; a CSV file is needed");
}

RC_GTEST_PROP(Csv, WritingAndReadingGivesTheSameBits, ()) {
  const auto rows = *rc::gen::inRange<std::size_t>(1, 20);
  Table table{"", {"a", "b, c"}, {{}, {}}, {}, {}};
  for (std::size_t row = 0; row < rows; ++row) {
    for (auto& column : table.columns) {
      column.push_back(std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>()));
    }
    table.lines.push_back(row + 2);
  }
  const TemporaryFolder folder;
  write_csv(folder / "table.csv", table);
  const Table read = read_csv(folder / "table.csv");
  RC_ASSERT(read.names == table.names);
  RC_ASSERT(read.lines == table.lines);
  for (std::size_t column = 0; column < 2; ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      const double written = table.columns[column][row];
      const double got = read.columns[column][row];
      const bool same = std::isnan(written) ? std::isnan(got)
                                            : std::bit_cast<std::uint64_t>(written) ==
                                                  std::bit_cast<std::uint64_t>(got);
      RC_ASSERT(same);
    }
  }
}

// Whatever the bytes, the answer is a table or an InputError.
RC_GTEST_PROP(Csv, SurvivesGarbage, ()) {
  const auto pieces = *rc::gen::container<std::vector<std::string>>(
      rc::gen::element<std::string>("u", "v", ",", ";", "\t", "\n", "\r\n", "\"", "\"\"", "#", "1",
                                    "-2.5e3", "nan", " ", "\xFF", "x"));
  std::string text;
  for (const std::string& piece : pieces) {
    text += piece;
  }
  try {
    const Table table = parse(text);
    RC_ASSERT(table.rows() > 0);
    for (const auto& column : table.columns) {
      RC_ASSERT(column.size() == table.rows());
    }
  } catch (const InputError&) {
    RC_SUCCEED();
  }
}

TEST(Csv, ReadsTheRealLog) {
  const auto file = testing::data_file("dagon_config1.csv");
  if (file.empty()) {
    GTEST_SKIP() << "the log of AUV Dagon is not here";
  }
  const Table table = read_csv(file);
  EXPECT_EQ(table.rows(), 11'567U);
  EXPECT_EQ(table.names,
            (std::vector<std::string>{"u", "v", "r", "th1", "th2", "th3", "udot", "vdot", "rdot"}));
  EXPECT_EQ(table.columns[0][0], 0.018734009121);
  EXPECT_EQ(table.columns[8][3], 0.0188210129129);
}

}  // namespace
}  // namespace kelpie
