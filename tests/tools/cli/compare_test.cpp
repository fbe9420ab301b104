// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/command.hpp"
#include "cli/running.hpp"

namespace kelpie::compare_test {
namespace {

using testing::kelpie;
using testing::little_log;
using testing::Outcome;
using testing::Running;

class Compare : public testing::CommandTest {
 protected:
  void SetUp() override { write("log.csv", little_log(2400)); }

  nlohmann::json json(const std::string& file) const { return parsed(file); }

  void expect_refused(const std::string& arguments, const std::string& message) {
    testing::expect_refused(run("compare " + arguments + " --out refused"), message);
    EXPECT_FALSE(exists("refused")) << arguments;
  }
};

TEST_F(Compare, HasTheFiguresOfLearnWithAnyNumberOfThreads) {
  const std::string rows =
      " log.csv --split pieces --set buffer=100 --set learner=svr --set warmup=200";
  const Outcome outcome = testing::succeeded(run("compare" + rows + " --threads 2 --out two"));
  EXPECT_EQ(outcome.err, "");  // no progress bar without a terminal
  testing::succeeded(run("compare" + rows + " --threads 1 --out one"));
  EXPECT_EQ(content("one/compare.json"), content("two/compare.json"));
  testing::succeeded(run("learn" + rows + " --out learn"));

  const nlohmann::json learned = json("learn/result.json");
  const nlohmann::json compared = json("two/compare.json");
  EXPECT_EQ(compared["dataset"], learned["dataset"]);
  EXPECT_EQ(compared["split"], learned["split"]);
  const nlohmann::json& axis = learned["axes"][0];
  const nlohmann::json& first = compared["contenders"][0]["axes"][0];
  EXPECT_EQ(first["r2"]["final"], axis["r2"]["final"]);
  EXPECT_EQ(first["prequential_r2"], axis["prequential_r2"]);
  for (const nlohmann::json& contender : compared["contenders"]) {
    if (axis["yardsticks"].contains(contender["kind"].get<std::string>())) {
      const nlohmann::json& baseline = axis["yardsticks"][contender["kind"].get<std::string>()];
      EXPECT_EQ(contender["axes"][0]["r2"]["final"], baseline["r2_final"]);
      EXPECT_EQ(contender["axes"][0]["prequential_r2"], baseline["prequential_r2"]);
    }
  }
}

TEST_F(Compare, RecommendsLeastSquaresWhereTheTargetIsLinearInTheTerms) {
  const Outcome outcome = testing::succeeded(
      run("compare log.csv --split tail --set buffer=20 --set learner=svr --out out"));
  EXPECT_NE(outcome.out.find("udot: least squares on physics terms is better"), std::string::npos)
      << outcome.out;
  EXPECT_NE(content("out/compare.html").find("least squares on physics terms"), std::string::npos);
}

TEST_F(Compare, KeepsTheDefaultsWhereNothingGainsAndNamesTheNextCommand) {
  const std::string rows = "compare log.csv --split pieces --set buffer=100 --out out";
  const Outcome outcome = testing::succeeded(run(rows));
  EXPECT_NE(outcome.out.find("No gain: keep the defaults."), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("next:   kelpie learn log.csv --split pieces --set buffer=100\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(outcome.out.find("mean over the stream"), std::string::npos) << outcome.out;
  EXPECT_NE(run(rows + " --verbose").out.find("mean over the stream"), std::string::npos);
  EXPECT_EQ(run(rows + " --quiet").out, "");
  EXPECT_EQ(run(rows + " --json").out, content("out/compare.json"));
  testing::expect_refused(run(rows + " --json --quiet"), "--quiet");
}

TEST_F(Compare, RecommendsTheMeanWhereTheInputsSayNothing) {
  RandomStream random(1, "noise");
  std::string text = "t,u,n,udot\n";
  for (int i = 0; i < 600; ++i) {
    text += std::to_string(i) + "," + std::to_string(random.normal()) + "," +
            std::to_string(random.normal()) + "," + std::to_string(random.normal()) + "\n";
  }
  write("noise.csv", text);
  const Outcome outcome =
      testing::succeeded(run("compare noise.csv --split pieces --set buffer=50 --out out"));
  EXPECT_NE(outcome.out.find("nothing here predicts better than the mean"), std::string::npos)
      << outcome.out;
}

TEST_F(Compare, AVariantThatIsKelpieIsNoContenderAndOneThatCannotLearnIsLeftOut) {
  std::istringstream rows(little_log(600));
  std::string twice;
  for (std::string row; std::getline(rows, row);) {  // n again: the full covariance is singular
    const std::size_t n = row.find(',', row.find(',') + 1);
    const std::string column = row.substr(n + 1, row.find(',', n + 1) - n - 1);
    twice += row + "," + (column == "n" ? "m" : column) + "\n";
  }
  write("twice.csv", twice);
  const Outcome outcome =
      testing::succeeded(run("compare twice.csv --inputs u,n,m --split pieces --set buffer=50 "
                             "--set adapt=none --out out --verbose"));
  const nlohmann::json compared = json("out/compare.json");
  std::vector<std::string> names;
  for (const nlohmann::json& contender : compared["contenders"]) {
    names.push_back(contender["name"]);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"kelpie", "learner=svr", "terms=none", "least squares",
                                             "mean", "last value"}));
  EXPECT_NE(compared["left_out"]["preset=paper"].get<std::string>().find("singular"),
            std::string::npos);
  EXPECT_NE(outcome.out.find("Left out: preset=paper"), std::string::npos) << outcome.out;
}

TEST_F(Compare, RefusesWhatLearnRefuses) {
  expect_refused("missing.csv", "missing.csv");
  expect_refused("log.csv --split peaces", "did you mean 'pieces'?");
  expect_refused("log.csv --set gama=1", "did you mean 'gamma'?");
  expect_refused("log.csv --inputs u,m --targets udot", "there is no such column");
  write("short.csv", little_log(4));
  expect_refused("short.csv --split pieces", "needs 25 or more");
  write("text.csv", "t,u,udot\n0,1,a\n1,2,b\n");
  expect_refused("text.csv", "text.csv:2");
}

TEST_F(Compare, InterruptedItWritesNothing) {
  write("long.csv", little_log(30000));
  Running running(folder_.path(), {"compare", "long.csv", "--out", "out", "--threads", "1"});
  ASSERT_TRUE(running.wait_for_text("comparing ["));
  running.press_ctrl_c();
  EXPECT_EQ(running.exit_code(), 1);
  EXPECT_NE(running.terminal_text().find("interrupted; nothing was written"), std::string::npos);
  EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace kelpie::compare_test
