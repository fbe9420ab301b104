// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/command.hpp"
#include "cli/running.hpp"
#include "cli/shell.hpp"
#include "file/out_folder.hpp"
#include "support.hpp"

namespace kelpie::learn_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::little_log;
using testing::Outcome;
using testing::Running;
using testing::shell;
using testing::TemporaryFolder;
using testing::write_text;

class Learn : public ::testing::Test {
 protected:
  void SetUp() override { write_text(folder_ / "log.csv", little_log(2400)); }

  // The command has to refuse with exit code 2, say why, and write nothing.
  void expect_refused(const std::string& arguments, const std::string& message) {
    const Outcome outcome = kelpie(folder_.path(), "learn " + arguments + " --out refused");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused")) << arguments;
  }

  TemporaryFolder folder_;
};

TEST_F(Learn, WritesResultReportAndModel) {
  const Outcome outcome = kelpie(folder_.path(), "learn log.csv --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no progress bar without a terminal
  EXPECT_NE(outcome.out.find("udot"), std::string::npos);
  const auto result = nlohmann::json::parse(content_of(folder_ / "out" / "result.json"));
  EXPECT_EQ(result["dataset"]["rows"], 2400);
  EXPECT_NEAR(result["dataset"]["rate_hz"].get<double>(), 10.0, 1e-6);
  EXPECT_EQ(result["settings"]["buffer"], 900);
  const auto& axis = result["axes"][0];
  EXPECT_EQ(axis["name"], "udot");
  EXPECT_GT(axis["r2"]["final"].get<double>(), 0.95);
  EXPECT_LE(axis["kkt_gap"].get<double>(), 1e-3);
  EXPECT_GT(axis["yardsticks"]["least_squares"]["r2_final"].get<double>(), 0.99);
  EXPECT_GT(axis["yardsticks"]["last_value"]["prequential_r2"].get<double>(), 0.5);
  EXPECT_LT(axis["yardsticks"]["mean"]["r2_final"].get<double>(), 0.01);
  EXPECT_GT(axis["disturbance"]["prequential_r2"].get<double>(),
            axis["prequential_r2"].get<double>() - 0.001);
  EXPECT_NEAR(axis["disturbance"]["intervals"]["held"].get<double>(), 0.9, 0.02);
  EXPECT_NE(outcome.out.find("with disturbance"), std::string::npos);
  EXPECT_NE(outcome.out.find("least squares"), std::string::npos);
  EXPECT_NE(content_of(folder_ / "out" / "report.html").find("figure class=\"chart\""), std::string::npos);
}

TEST_F(Learn, AColumnOfTheLogSaysWhichRowsAreHeldOut) {
  // The last of every five blocks of 400 rows, as --split blocks takes them.
  std::istringstream rows(little_log(2400));
  std::string marked;
  std::string row;
  for (int number = -1; std::getline(rows, row); ++number) {
    marked += row + (number < 0 ? ",held" : number / 400 == 4 ? ",1" : ",0") + "\n";
  }
  write_text(folder_ / "marked.csv", marked);
  ASSERT_EQ(kelpie(folder_.path(), "learn log.csv --out blocks").exit_code, 0);
  ASSERT_EQ(kelpie(folder_.path(), "learn marked.csv --split column:held --out column").exit_code,
            0);
  const auto result = [&](const std::string& out) {
    return nlohmann::json::parse(content_of(folder_ / out / "result.json"));
  };
  EXPECT_EQ(result("column")["dataset"]["inputs"], result("blocks")["dataset"]["inputs"]);
  EXPECT_EQ(result("column")["axes"][0]["r2"], result("blocks")["axes"][0]["r2"]);
  expect_refused("marked.csv --split column:hold",
                 "marked.csv: hold: there is no such column (did you mean 'held'?)");
  expect_refused("marked.csv --split column", "split: 'column' needs the name of a column");
}

TEST_F(Learn, ThePredictionsOfTheSavedModelAreThoseOfTheRun) {
  ASSERT_EQ(kelpie(folder_.path(), "learn log.csv --split tail --out out").exit_code, 0);
  // The held-out rows of a tail split are the end of the log.
  const std::string log = content_of(folder_ / "log.csv");
  std::size_t start = 0;
  for (int line = 0; line < 1 + 1920; ++line) {
    start = log.find('\n', start) + 1;
  }
  write_text(folder_ / "tail.csv", "t,u,n,udot\n" + log.substr(start));
  const Outcome outcome =
      kelpie(folder_.path(), "predict --model out/model.json tail.csv --out p.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto result = nlohmann::json::parse(content_of(folder_ / "out" / "result.json"));
  const std::string expected = fmt::format("udot: R² {:.3f} over 480 of 480 rows",
                                           result["axes"][0]["r2"]["final"].get<double>());
  EXPECT_NE(outcome.out.find(expected), std::string::npos) << outcome.out;
  EXPECT_EQ(content_of(folder_ / "p.csv").substr(0, 26), "t,u,n,udot,udot_predicted,");
}

TEST_F(Learn, SameSeedSameModelOtherSeedAnother) {
  const auto model = [&](const std::string& arguments) {
    EXPECT_EQ(
        kelpie(folder_.path(), "learn log.csv --split random --out out " + arguments).exit_code, 0);
    return content_of(folder_ / "out" / "model.json");
  };
  const std::string first = model("--seed 3");
  EXPECT_EQ(model("--seed 3"), first);
  EXPECT_NE(model("--seed 4"), first);
}

TEST_F(Learn, ConfigFileThenSetOverThePreset) {
  write_text(folder_ / "c.toml", "buffer = 100\nepsilon = 0.2\n[log]\ninputs = ['u']\n");
  ASSERT_EQ(
      kelpie(folder_.path(), "learn log.csv --config c.toml --set epsilon=0.3 --out out").exit_code,
      0);
  const auto result = nlohmann::json::parse(content_of(folder_ / "out" / "result.json"));
  EXPECT_EQ(result["settings"]["buffer"], 100);
  EXPECT_EQ(result["settings"]["epsilon"], 0.3);
  EXPECT_EQ(result["dataset"]["inputs"], nlohmann::json({"u"}));
}

TEST_F(Learn, CoefficientsAreShownWithTheUnitsGiven) {
  write_text(folder_ / "c.toml",
             "terms = 'u*|u|; n*|n|'\nlambda = 10\nfine = 0\nc = 0.1\n[log]\n"
             "units = {u = 'm/s', n = 'rad/s', udot = 'cm/s^2'}\n");
  const Outcome outcome =
      kelpie(folder_.path(), "learn log.csv --config c.toml --units n=rev/s,udot=m/s^2 --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("udot in m s^-2\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("m rev^-2"), std::string::npos) << outcome.out;
  const auto result = nlohmann::json::parse(content_of(folder_ / "out" / "result.json"));
  const auto& coefficients = result["axes"][0]["coefficients"];
  EXPECT_EQ(coefficients["units"], nlohmann::json({"m^-1", "m rev^-2"}));
  EXPECT_NEAR(coefficients["final"][1].get<double>(), 0.01, 0.001);
  EXPECT_NE(content_of(folder_ / "out" / "report.html").find(">Coefficients</h2>"),
            std::string::npos);
}

TEST_F(Learn, ScalesCanComeFromAnEarlierModel) {
  ASSERT_EQ(kelpie(folder_.path(), "learn log.csv --out a").exit_code, 0);
  ASSERT_EQ(kelpie(folder_.path(), "learn log.csv --scales a/model.json --out b").exit_code, 0);
  const auto scaling = [&](const std::string& name) {
    return nlohmann::json::parse(content_of(folder_ / name / "model.json"))["axes"][0]["scaling"];
  };
  EXPECT_EQ(scaling("a"), scaling("b"));
  expect_refused("log.csv --inputs u --targets udot --scales a/model.json", "is a model of u,n");
}

// Ctrl-C, and SIGTERM as a service manager sends it.
class LearnStopped : public Learn, public ::testing::WithParamInterface<int> {};

INSTANTIATE_TEST_SUITE_P(Signals, LearnStopped, ::testing::Values(SIGINT, SIGTERM));

TEST_P(LearnStopped, StillWritesWhatItHas) {
  write_text(folder_ / "long.csv", little_log(40'000));
  Running learning(folder_.path(), {"learn", "long.csv", "--set", "epsilon=0.001", "--set",
                                    "gamma=2", "--checkpoint-every", "1000000", "--out", "out"});
  ASSERT_TRUE(learning.wait_for_text("[#")) << learning.terminal_text();  // a thirtieth is done
  if (GetParam() == SIGINT) {
    learning.press_ctrl_c();
  } else {
    learning.send(GetParam());
  }
  ASSERT_EQ(learning.exit_code(), 0) << learning.terminal_text();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "checkpoint.kelpie"));
  const auto result = nlohmann::json::parse(content_of(folder_ / "out" / "result.json"));
  EXPECT_TRUE(result["interrupted"].get<bool>());
  EXPECT_LT(result["samples_shown"].get<int>(), 32'000);
  EXPECT_GE(result["samples_shown"].get<int>(), 32'000 / 30);
  EXPECT_GT(result["axes"][0]["r2"]["final"].get<double>(), 0.5);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "model.json"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "report.html"));
}

TEST_F(Learn, SkippedRowsAreCounted) {
  std::string log = little_log(2400);
  log.insert(log.find('\n') + 1, "-2,nan,1,1\n-1,1,inf,1\n");
  write_text(folder_ / "holes.csv", log);
  ASSERT_EQ(kelpie(folder_.path(), "learn holes.csv --out out").exit_code, 0);
  const auto result = nlohmann::json::parse(content_of(folder_ / "out" / "result.json"));
  EXPECT_EQ(result["dataset"]["rows"], 2402);
  EXPECT_EQ(result["dataset"]["rows_skipped"], 2);
}

TEST_F(Learn, AbsurdRowsLeaveNothingThatCannotBeRead) {
  std::istringstream rows(little_log(2400));
  std::string log;
  std::string row;
  for (int number = 0; std::getline(rows, row); ++number) {
    log += (number == 30     ? "2.9,-1e307,1e-320,1"
            : number == 700  ? "69.9,0.1,0.2,1.7976931348623157e308"
            : number == 1200 ? "119.9,1e100,0.2,0.1"
            : number == 1201 ? "120,3.4028235e38,-1e49,3.4028235e38"
                             : row) +
           "\n";
  }
  write_text(folder_ / "absurd.csv", log);
  const std::string learn = "learn absurd.csv --checkpoint-every 100 --memory m.json --out out";
  ASSERT_EQ(kelpie(folder_.path(), learn).exit_code, 0);
  const Outcome again = kelpie(folder_.path(), learn + " --resume");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  const Outcome predicted =
      kelpie(folder_.path(), "predict --model out/model.json log.csv --out p.csv");
  EXPECT_EQ(predicted.exit_code, 0) << predicted.err;
  EXPECT_EQ(content_of(folder_ / "p.csv").find(",nan"), std::string::npos);
}

TEST_F(Learn, RefusesBadLogs) {
  expect_refused("none.csv", "none.csv: cannot be read: No such file or directory");
  write_text(folder_ / "empty.csv", "");
  expect_refused("empty.csv", "empty.csv: is empty");
  write_text(folder_ / "ragged.csv", "t,u,udot\n0,1,2\n1,2\n");
  expect_refused("ragged.csv", "ragged.csv:3: 2 cells in this row; the header has 3");
  write_text(folder_ / "text.csv", "t,u,udot\n0,1,2\n1,two,3\n");
  expect_refused("text.csv --inputs u", "text.csv:3: u: 'two' is not a number");
  write_text(folder_ / "back.csv", "t,u,udot\n5,1,2\n4,2,3\n");
  expect_refused("back.csv", "back.csv:3: t: time runs backwards, from 5 (line 2) to 4 s");
  write_text(folder_ / "same.csv", "t,u,n,udot\n0,1,7,2\n1,2,7,3\n2,3,7,4\n");
  expect_refused("same.csv", "same.csv: n: is 7 in every row: a singular covariance");
  write_text(folder_ / "twice.csv", "t,u,u,udot\n0,1,7,2\n");
  expect_refused("twice.csv", "twice.csv:1: u: two columns have this name");
  write_text(folder_ / "short.csv", little_log(100));
  expect_refused("short.csv --split blocks", "needs 1601 or more");
  expect_refused("log.csv --inputs u,m", "m: there is no such column (did you mean");
}

TEST_F(Learn, RefusesBadSettings) {
  expect_refused("log.csv --set buffer=0", "--set: buffer: 0 is out of range");
  expect_refused("log.csv --set epsilon=-1", "--set: epsilon: -1 is out of range");
  expect_refused("log.csv --set gama=1", "--set: gama: unknown setting (did you mean 'gamma'?)");
  expect_refused("log.csv --set gamma", "'gamma' is not of the form key=value");
  expect_refused("log.csv --set forget=lifo", "'lifo' is not one of fifo, paper, age");
  expect_refused("log.csv --split half",
                 "split: there is no 'half'; choose random, blocks, pieces, tail");
  expect_refused("log.csv --rate 3 --time t", "--time");
  expect_refused("log.csv --checkpoint-every -1",
                 "--checkpoint-every: -1 has to be a whole number, 0 or more");
  expect_refused("log.csv --rate -3", "rate: -3 is out of range");
  expect_refused("log.csv --units u", "--units: 'u' is not of the form key=value");
  expect_refused("log.csv --units u=m/s2", "log.csv: u: 'm/s2' is not a unit such as m/s^2");
  expect_refused("log.csv --units udt=m/s", "no such column (did you mean 'udot'?)");
  write_text(folder_ / "units.toml", "[log]\nunits = ['m/s']\n");
  expect_refused("log.csv --config units.toml",
                 "units.toml:2: log.units: has to be a table of units");
  expect_refused("log.csv --config none.toml", "none.toml: cannot be read");
  expect_refused("log.csv --scales none.json", "none.json: cannot be read");
  write_text(folder_ / "bad.toml", "gamma = 0.1\nbufer = 3\n");
  expect_refused("log.csv --config bad.toml",
                 "bad.toml:2: bufer: unknown setting (did you mean 'buffer'?)");
  write_text(folder_ / "syntax.toml", "gamma = 0.1\nbuffer = = 3\n");
  expect_refused("log.csv --config syntax.toml", "syntax.toml:2: is not TOML");
  write_text(folder_ / "log.toml", "[log]\ninput = ['u']\n");
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
  write_text(folder_ / "faulty.csv", faulty);
  expect_refused("faulty.csv", "faulty.csv:1001: n: 'N/A' is not a number");
  write_text(folder_ / "words.csv", words);
  const Outcome outcome = kelpie(folder_.path(), "learn words.csv --out out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err,
            "words.csv:2: note: is left out of the inputs: 'dive 7' is not a number\n");
}

TEST_F(Learn, ItsInputsMayBePipesAndStandWhereResultsGoOnlyUnderOtherNames) {
  write_text(folder_ / "c.toml", "buffer = 100\n[log]\ninputs = ['u', 'n']\n");
  const std::string said =
      shell(folder_,
            KELPIE_COMMAND " learn <(cat log.csv) --config <(cat c.toml) --out pipes >/dev/null");
  EXPECT_EQ(said, "");
  ASSERT_EQ(kelpie(folder_.path(), "learn log.csv --config c.toml --out files").exit_code, 0);
  EXPECT_EQ(content_of(folder_ / "pipes" / "model.json"),
            content_of(folder_ / "files" / "model.json"));
  const Outcome outcome =
      kelpie(folder_.path(), "learn log.csv --scales files/model.json --out files");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("files/model.json: --out: would replace what is read"),
            std::string::npos)
      << outcome.err;
}

TEST_F(Learn, RefusesAFolderThatAnotherRunIsWritingInto) {
  const file::OutFolder other(folder_ / "out", {});
  const Outcome outcome = kelpie(folder_.path(), "learn log.csv --out out --resume");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("out: --out: another run is writing into this folder"),
            std::string::npos)
      << outcome.err;
}

// Before learning: it would all be lost.
TEST_F(Learn, AMemoryThatCannotBeWrittenIsFoundFirst) {
  const Outcome outcome = kelpie(folder_.path(), "learn log.csv --memory nodir/m.json --out out");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("nodir/m.json: cannot be written: No such file or directory"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

// A full disk must not leave half a result: the folder's name is taken by a file.
TEST_F(Learn, AnUnwritablePlaceIsAFailureNotAnInputError) {
  write_text(folder_ / "file", "");
  const Outcome outcome = kelpie(folder_.path(), "learn log.csv --out file/out");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("file/out: cannot be written"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace kelpie::learn_test
