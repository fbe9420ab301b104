// SPDX-License-Identifier: Apache-2.0
// What `kelpie learn` refuses.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

#include "cli/learn_command.hpp"
#include "file/out_folder.hpp"

namespace kelpie::learn_refusals_test {
namespace {

using testing::kelpie;
using testing::Learn;
using testing::little_log;
using testing::Outcome;

TEST_F(Learn, RefusesBadLogs) {
  write("ragged.csv", "t,u,udot\n0,1,2\n1,2\n");
  expect_refused("ragged.csv", "ragged.csv:3: 2 cells in this row; the header has 3");
  write("back.csv", "t,u,udot\n5,1,2\n4,2,3\n");
  expect_refused("back.csv", "back.csv:3: t: time runs backwards, from 5 (line 2) to 4 s");
  std::string swapped = "u,t,n,udot\n";
  for (int i = 0; i < 100; ++i) {
    swapped += fmt::format("{},{},{},{}\n", i, 0.2 * std::sin(i), std::cos(i), std::sin(2.0 * i));
  }
  write("swapped.csv", swapped);
  expect_refused("swapped.csv", "is this a column of time? --time names another");
  write("twice.csv", "t,u,u,udot\n0,1,7,2\n");
  expect_refused("twice.csv", "twice.csv:1: u: two columns have this name");
  write("short.csv", little_log(100));
  expect_refused("short.csv --split blocks", "needs 1601 or more");
  expect_refused("log.csv --inputs u,m", "m: there is no such column (did you mean");
}

TEST_F(Learn, RefusesTargetsThatCannotBeAccelerations) {
  std::string text = "t,u,n,udot\n";
  double u = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double n = std::sin(0.05 * i) + std::sin(0.013 * i);
    text += fmt::format("{},{},{},{}\n", 0.2 * i, 100.0 * u, n, n - u);  // u in cm/s
    u += 0.2 * (n - u);
  }
  write("cm.csv", text);
  expect_refused("cm.csv", "cm.csv: targets: u is in cm/s, udot in m/s²");
  expect_refused("cm.csv", "; --units u=cm/s converts; --accept implausible learns the log");
  testing::succeeded(run("learn cm.csv --units u=cm/s --out converted"));
  EXPECT_GT(parsed("converted/result.json")["axes"][0]["r2"]["final"].get<double>(), 0.9);
  testing::succeeded(run("learn cm.csv --accept implausible --out accepted"));
  expect_refused("cm.csv --accept anything", "--accept: anything not in {implausible}");
}

TEST_F(Learn, RefusesBadSettings) {
  expect_refused("log.csv --set buffer=0", "--set: buffer: 0 is out of range");
  expect_refused("log.csv --set epsilon=-1", "--set: epsilon: -1 is out of range");
  expect_refused("log.csv --set gamma", "'gamma' is not of the form key=value");
  expect_refused("log.csv --set forget=lifo",
                 "'lifo' is no choice (did you mean 'fifo'?); there are fifo, paper, age");
  expect_refused("log.csv --split half",
                 "split: 'half' is no split; there are random, blocks, pieces, tail");
  expect_refused("log.csv --units u", "--units: 'u' is not of the form key=value");
  expect_refused("log.csv --units udt=m/s", "no such column (did you mean 'udot'?)");
  write("units.toml", "[log]\nunits = ['m/s']\n");
  expect_refused("log.csv --config units.toml",
                 "units.toml:2: log.units: has to be a table of units");
  expect_refused("log.csv --config none.toml", "none.toml: cannot be read");
  expect_refused("log.csv --scales none.json", "none.json: cannot be read");
  write("bad.toml", "gamma = 0.1\nbufer = 3\n");
  expect_refused("log.csv --config bad.toml",
                 "bad.toml:2: bufer: unknown setting (did you mean 'buffer'?)");
  write("syntax.toml", "gamma = 0.1\nbuffer = = 3\n");
  expect_refused("log.csv --config syntax.toml", "syntax.toml:2: is not TOML");
  write("log.toml", "[log]\ninput = ['u']\n");
  expect_refused("log.csv --config log.toml",
                 "log.toml:2: log.input: unknown key (did you mean 'inputs'?)");
}

TEST_F(Learn, ACellThatIsNoNumberIsRefusedAndAColumnOfWordsLeftOutAloud) {
  std::istringstream rows(little_log(2400));
  std::string words;
  std::string faulty;
  std::string row;
  for (int number = 0; std::getline(rows, row); ++number) {
    words += row + (number == 0 ? ",note\n" : ",dive 7\n");
    faulty += (number == 1000 ? "99.9,0.1,N/A,0.2" : row) + "\n";
  }
  write("faulty.csv", faulty);
  expect_refused("faulty.csv", "faulty.csv:1001: n: 'N/A' is not a number");
  write("words.csv", words);
  const Outcome outcome = run("learn words.csv --out out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err,
            "words.csv:2: note: is left out of the inputs: 'dive 7' is not a number\n");
}

TEST_F(Learn, RefusesAFolderThatAnotherRunIsWritingInto) {
  const file::OutFolder other(folder_ / "out", {});
  const Outcome outcome = run("learn log.csv --out out --resume");
  testing::expect_refused(outcome, "out: --out: another run is writing into this folder");
}

// Before learning: it would all be lost.
TEST_F(Learn, AMemoryThatCannotBeWrittenIsFoundFirst) {
  const Outcome outcome = run("learn log.csv --memory nodir/m.json --out out");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("nodir/m.json: cannot be written: No such file or directory"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(exists("out"));
}

// A full disk must not leave half a result: the folder's name is taken by a file.
TEST_F(Learn, AnUnwritablePlaceIsAFailureNotAnInputError) {
  write("file", "");
  const Outcome outcome = run("learn log.csv --out file/out");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("file/out: cannot be written"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace kelpie::learn_refusals_test
