// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/learn_command.hpp"
#include "cli/running.hpp"
#include "cli/shell.hpp"

namespace kelpie::learn_test {
namespace {

using testing::content_of;
using testing::kelpie;
using testing::Learn;
using testing::little_log;
using testing::Outcome;
using testing::Running;
using testing::shell;

TEST_F(Learn, WritesResultReportAndModel) {
  const Outcome outcome = testing::succeeded(run("learn log.csv --out out --verbose"));
  EXPECT_EQ(outcome.err, "");  // no progress bar without a terminal
  EXPECT_NE(outcome.out.find("udot"), std::string::npos);
  const auto result = parsed("out/result.json");
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
  EXPECT_NE(content("out/report.html").find("figure class=\"chart\""), std::string::npos);
}

TEST_F(Learn, AStampFromAnotherAgeDoesNotHoldUpThePage) {
  std::string log = little_log(600);
  const std::size_t second = log.find('\n') + 1;
  log.replace(second, log.find(',', second) - second, "-1e308");
  write("log.csv", log);
  testing::succeeded(run("learn log.csv --set buffer=50 --out out"));
  EXPECT_TRUE(exists("out/report.html"));
}

TEST_F(Learn, AnswersWithAVerdictOrWithNothing) {
  const Outcome verdict = testing::succeeded(run("learn log.csv --out out"));
  EXPECT_EQ(verdict.out.find("Learned "), 0U) << verdict.out;
  for (const char* const words : {"velocities: u\n", "commands: n", "without commands",
                                  "vehicle: no change", "next:   kelpie rollout log.csv"}) {
    EXPECT_NE(verdict.out.find(words), std::string::npos) << verdict.out;
  }
  EXPECT_LE(std::ranges::count(verdict.out, '\n'), 20) << verdict.out;
  EXPECT_TRUE(parsed("out/result.json")["axes"][0]["yardsticks"].contains("without_commands"));
  EXPECT_EQ(testing::succeeded(run("learn log.csv --out out --quiet")).out, "");
}

// Followed literally, with the log that is at hand.
TEST_F(Learn, TheNextCommandsKeepTheUnitsOfTheLog) {
  const Outcome outcome = testing::succeeded(run(
      "learn log.csv --units u=cm/s,udot=cm/s^2 --split none --out out" + testing::kFewSamples));
  const auto follow = [&](const std::string& begin) {
    const std::size_t at = outcome.out.find("kelpie " + begin);
    ASSERT_NE(at, std::string::npos) << outcome.out;
    std::string next = outcome.out.substr(at + 7, outcome.out.find("   (", at) - at - 7);
    next.replace(next.find("LOG"), 3, "log.csv");
    const Outcome followed = testing::succeeded(run(next + " --out " + begin.substr(0, 5)));
    EXPECT_EQ(followed.err, "");
    EXPECT_EQ(followed.out.find("R² -"), std::string::npos) << followed.out;
  };
  follow("predict");
  follow("learn LOG");
  EXPECT_EQ(outcome.out.find("kelpie rollout"), std::string::npos) << outcome.out;
}

TEST_F(Learn, TheVerdictNamesTheLogsAndTheRowsLeftOut) {
  std::filesystem::create_directories(folder_ / "a");
  std::filesystem::create_directories(folder_ / "b");
  std::string gaps = little_log(2400);
  for (std::size_t row = 0, at = 0; (at = gaps.find('\n', at + 1)) + 1 < gaps.size(); ++row) {
    if (row % 10 == 5) {  // no command
      const std::size_t begin = gaps.find(',', gaps.find(',', at + 1) + 1) + 1;
      gaps.erase(begin, gaps.find(',', begin) - begin);
    }
  }
  write("a/one.csv", gaps);
  write("b/two.csv", little_log(2400));
  const std::string few = " --out out" + testing::kFewSamples;
  EXPECT_NE(run("learn a/one.csv b/two.csv" + few).out.find(" rows of one.csv, two.csv ("),
            std::string::npos);
  const Outcome outcome = testing::succeeded(run("learn a/one.csv" + few));
  EXPECT_NE(outcome.out.find("; 240 of 2,400 rows lack a value and are left out\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(run("learn b/two.csv" + few).out.find("lack a value"), std::string::npos);
}

TEST_F(Learn, AColumnOfTheLogSaysWhichRowsAreHeldOut) {
  // The last of every five blocks of 400 rows, as --split blocks takes them.
  std::istringstream rows(little_log(2400));
  std::string marked;
  std::string row;
  for (int number = -1; std::getline(rows, row); ++number) {
    marked += row + (number < 0 ? ",held" : number / 400 == 4 ? ",1" : ",0") + "\n";
  }
  write("marked.csv", marked);
  testing::succeeded(run("learn log.csv --out blocks"));
  ASSERT_EQ(run("learn marked.csv --split column:held --out column").exit_code, 0);
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
  testing::succeeded(run("learn log.csv --split tail --out out"));
  // The held-out rows of a tail split are the end of the log.
  const std::string log = content("log.csv");
  std::size_t start = 0;
  for (int line = 0; line < 1 + 1920; ++line) {
    start = log.find('\n', start) + 1;
  }
  write("tail.csv", "t,u,n,udot\n" + log.substr(start));
  const Outcome outcome =
      testing::succeeded(run("predict --model out/model.json tail.csv --out p.csv"));
  const auto result = parsed("out/result.json");
  const std::string expected = fmt::format("udot: R² {:.3f} over 480 of 480 rows",
                                           result["axes"][0]["r2"]["final"].get<double>());
  EXPECT_NE(outcome.out.find(expected), std::string::npos) << outcome.out;
  EXPECT_EQ(content("p.csv").substr(0, 26), "t,u,n,udot,udot_predicted,");
}

TEST_F(Learn, SameSeedSameModelOtherSeedAnother) {
  const auto model = [&](const std::string& arguments) {
    EXPECT_EQ(run("learn log.csv --split random --out out " + arguments).exit_code, 0);
    return content("out/model.json");
  };
  const std::string first = model("--seed 3");
  EXPECT_EQ(model("--seed 3"), first);
  EXPECT_NE(model("--seed 4"), first);
}

TEST_F(Learn, ConfigFileThenSetOverThePreset) {
  write("c.toml", "buffer = 100\nepsilon = 0.2\n[log]\ninputs = ['u']\n");
  ASSERT_EQ(run("learn log.csv --config c.toml --set epsilon=0.3 --out out").exit_code, 0);
  const auto result = parsed("out/result.json");
  EXPECT_EQ(result["settings"]["buffer"], 100);
  EXPECT_EQ(result["settings"]["epsilon"], 0.3);
  EXPECT_EQ(result["dataset"]["inputs"], nlohmann::json({"u"}));
}

TEST_F(Learn, CoefficientsAreShownWithTheUnitsGiven) {
  write("c.toml",
        "terms = 'u*|u|; n*|n|'\nlambda = 10\nfine = 0\nc = 0.1\n[log]\n"
        "units = {u = 'm/s', n = 'rad/s', udot = 'mm/s^2'}\n");
  const Outcome outcome = testing::succeeded(
      run("learn log.csv --config c.toml --units n=rev/s,udot=m/s^2 --out out --verbose"));
  EXPECT_NE(outcome.out.find("udot in m/s²\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("m/rev²"), std::string::npos) << outcome.out;
  const auto result = parsed("out/result.json");
  const auto& coefficients = result["axes"][0]["coefficients"];
  EXPECT_EQ(coefficients["units"], nlohmann::json({"m^-1", "m rev^-2"}));
  EXPECT_NEAR(coefficients["final"][1].get<double>(), 0.01, 0.001);
  EXPECT_NE(content("out/report.html").find(">Coefficients</h2>"), std::string::npos);
}

TEST_F(Learn, ScalesCanComeFromAnEarlierModel) {
  testing::succeeded(run("learn log.csv --set learner=svr --out a"));
  testing::succeeded(run("learn log.csv --set learner=svr --scales a/model.json --out b"));
  const auto scaling = [&](const std::string& name) {
    return nlohmann::json::parse(content_of(folder_ / name / "model.json"))["axes"][0]["scaling"];
  };
  EXPECT_EQ(scaling("a"), scaling("b"));
  expect_refused("log.csv --inputs u --targets udot --scales a/model.json", "is a model of u,n");
  expect_refused("log.csv --scales a/model.json", "--scales: 'learner = posterior' takes no scale");
}

// Ctrl-C, and SIGTERM as a service manager sends it.
class LearnStopped : public Learn, public ::testing::WithParamInterface<int> {};

INSTANTIATE_TEST_SUITE_P(Signals, LearnStopped, ::testing::Values(SIGINT, SIGTERM));

TEST_P(LearnStopped, StillWritesWhatItHas) {
  write("long.csv", little_log(40'000));
  Running learning(folder_.path(), {"learn", "long.csv", "--set", "epsilon=0.001", "--set",
                                    "gamma=2", "--checkpoint-every", "1000000", "--out", "out"});
  ASSERT_TRUE(learning.wait_for_text("[#")) << learning.terminal_text();  // a thirtieth is done
  if (GetParam() == SIGINT) {
    learning.press_ctrl_c();
  } else {
    learning.send(GetParam());
  }
  ASSERT_EQ(learning.exit_code(), 0) << learning.terminal_text();
  EXPECT_TRUE(exists("out/checkpoint.kelpie"));
  const auto result = parsed("out/result.json");
  EXPECT_TRUE(result["interrupted"].get<bool>());
  EXPECT_LT(result["samples_shown"].get<int>(), 32'000);
  EXPECT_GE(result["samples_shown"].get<int>(), 32'000 / 30);
  EXPECT_GT(result["axes"][0]["r2"]["final"].get<double>(), 0.5);
  EXPECT_TRUE(exists("out/model.json"));
  EXPECT_TRUE(exists("out/report.html"));
}

TEST_F(Learn, SkippedRowsAreCounted) {
  std::string log = little_log(2400);
  log.insert(log.find('\n') + 1, "-2,nan,1,1\n-1,1,inf,1\n");
  write("holes.csv", log);
  testing::succeeded(run("learn holes.csv --out out"));
  const auto result = parsed("out/result.json");
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
  write("absurd.csv", log);
  const std::string learn = "learn absurd.csv --checkpoint-every 100 --memory m.json --out out";
  testing::succeeded(run(learn));
  const Outcome again = run(learn + " --resume");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  const Outcome predicted = run("predict --model out/model.json log.csv --out p.csv");
  EXPECT_EQ(predicted.exit_code, 0) << predicted.err;
  EXPECT_EQ(content("p.csv").find(",nan"), std::string::npos);
}

TEST_F(Learn, ItsInputsMayBePipesAndStandWhereResultsGoOnlyUnderOtherNames) {
  write("c.toml", "buffer = 100\n[log]\ninputs = ['u', 'n']\n");
  const std::string said =
      shell(folder_,
            KELPIE_COMMAND " learn <(cat log.csv) --config <(cat c.toml) --out pipes >/dev/null");
  EXPECT_EQ(said, "");
  testing::succeeded(run("learn log.csv --config c.toml --out files"));
  EXPECT_EQ(content("pipes/model.json"), content("files/model.json"));
  testing::expect_refused(run("learn log.csv --scales files/model.json --out files"),
                          "files/model.json: --out: would overwrite an input");
}

TEST_F(Learn, ALogMayFollowAnyOption) {
  const std::string quick = " --split tail --out out";
  for (const char* const options :
       {"--set buffer=50 log.csv", "--inputs u,n --targets udot log.csv --set buffer=50",
        "--accept implausible log.csv --set buffer=50"}) {
    testing::succeeded(run("learn " + std::string(options) + quick));
  }
  testing::succeeded(run("export --units u=m/s,udot=m/s^2 out/model.json --c x.c"));
  testing::succeeded(run("learn --nominal out/model.json log.csv --set buffer=50 --out next"));
  expect_refused("log.csv --set buffer=50 c=1",
                 "'c=1' is no file; to give several settings, "
                 "repeat the option, as in --set a=1 --set b=2");
  expect_refused("--set buffer=50 c=1 log.csv", "'c=1' is no file");
}

TEST_F(Learn, AFrameWithoutAVehicleFileIsRefused) {
  expect_refused("log.csv --frame nonsense", "'nonsense' is no frame");
  expect_refused("log.csv --frame FRD", "--frame: says how a vehicle file of --nominal is turned");
}

}  // namespace
}  // namespace kelpie::learn_test
