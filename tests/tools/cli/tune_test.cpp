// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.hpp"

namespace kelpie::tune_test {
namespace {

class TuneCommand : public testing::CommandTest {
 protected:
  void SetUp() override { write_log("log.csv", "u,n,udot", 700, 0.5); }

  // Three columns: a velocity, a command, and the acceleration with so much drag.
  void write_log(const std::string& name, const std::string& columns, int rows, double drag) const {
    std::ofstream log(folder_ / name);
    log << "t," << columns << '\n';
    for (int i = 0; i < rows; ++i) {
      const double u = std::sin(0.11 * i);
      const double n = std::cos(0.043 * i) + 0.2 * std::sin(1.7 * i);
      log << i << ',' << u << ',' << n << ',' << n * std::abs(n) - drag * u << '\n';
    }
  }

  // Exit code; what was printed stands in said().
  int ran(const std::string& arguments) {
    const testing::Outcome outcome = run(arguments);
    said_ = outcome.out + outcome.err;
    return outcome.exit_code;
  }

  int tune(const std::string& more) {
    return ran("tune log.csv --out out --split tail --set buffer=60 --candidates 4 " + more);
  }

  const std::string& said() const { return said_; }

 private:
  std::string said_;
};

TEST_F(TuneCommand, WritesSettingsThatLearnTakesAndTheSameBytesWhenRunAgain) {
  ASSERT_EQ(tune("--threads 2 --verbose"), 0) << said();
  EXPECT_NE(said().find("paper (Table I)"), std::string::npos);
  const std::string toml = content("out/tuned.toml");
  const std::string json = content("out/tune.json");
  EXPECT_NE(toml.find("buffer = 60"), std::string::npos);
  ASSERT_EQ(tune("--threads 1"), 0) << said();
  EXPECT_NE(said().find("resuming with"), std::string::npos);
  EXPECT_EQ(content("out/tune.json"), json);

  const std::string config = " --config out/tuned.toml";
  ASSERT_EQ(ran("config --all --axes 1" + config), 0) << said();
  EXPECT_EQ("\n" + said(), toml.substr(toml.find("\n\n") + 1))
      << "the settings read back as written";
  EXPECT_EQ(ran("learn log.csv" + config + " --split tail --out learned"), 0) << said();
}

TEST_F(TuneCommand, SaysWhetherThereIsAGainAndWhatToRunNext) {
  ASSERT_EQ(tune("--search k=10:10.0001"), 0) << said();
  EXPECT_NE(said().find("No gain: keep the defaults."), std::string::npos) << said();
  EXPECT_NE(said().find("out/tuned.toml --split tail\n"), std::string::npos) << said();
  EXPECT_EQ(said().find("paper (Table I)"), std::string::npos) << said();
  EXPECT_EQ(tune("--search k=10:10.0001 --quiet"), 0);
  EXPECT_EQ(said().find("Searched"), std::string::npos) << said();
}

// Logs that are tuned together need not fit into one stream.
TEST_F(TuneCommand, TheNextCommandLearnsOneOfSeveralLogs) {
  write_log("more.csv", "u,n,udot", 700, 0.5);
  ASSERT_EQ(tune("more.csv --search k=10:10.0001"), 0) << said();
  EXPECT_NE(said().find("learn log.csv --config"), std::string::npos) << said();
  EXPECT_EQ(said().find("more.csv --config"), std::string::npos) << said();
}

// tuned.toml lacks the [log] that the next command needs.
TEST_F(TuneCommand, TheNextCommandLearnsALogThatItsConfigurationExplains) {
  write_log("named.csv", "forward,n,slope", 700, 0.5);
  write("c.toml",
        "buffer = 60\nc = 0.00001\n[log]\ninputs = [\"forward\", \"n\"]\n"
        "targets = [\"slope\"]\n");
  ASSERT_EQ(ran("tune named.csv --config c.toml --set warmup=30 --set learner=svr --candidates 4 "
                "--search c=1:100:log --out out"),
            0)
      << said();
  const std::string begin = "kelpie learn named.csv --config c.toml";
  const std::size_t at = said().find(begin);
  ASSERT_NE(at, std::string::npos) << said();
  const std::string next = said().substr(at + 7, said().find('\n', at) - at - 7);
  EXPECT_NE(next.find(" --set warmup=30"), std::string::npos) << next;
  EXPECT_NE(next.find(" --set c="), std::string::npos) << next;
  EXPECT_EQ(ran(next + " --out learned"), 0) << said();
}

TEST_F(TuneCommand, RefusesAJournalOfAnotherSearch) {
  ASSERT_EQ(tune(""), 0) << said();
  EXPECT_EQ(tune("--seed 2"), 2);
  EXPECT_NE(said().find("seed"), std::string::npos);
}

TEST_F(TuneCommand, TunesOnSeveralLogsAndTellsTheScoresOfEach) {
  write_log("other.csv", "u,thruster,udot", 300, 2.0);
  ASSERT_EQ(tune("other.csv --set learner=svr --verbose"), 0) << said();
  EXPECT_NE(said().find("Scores by log"), std::string::npos) << said();
  const nlohmann::json json = parsed("out/tune.json");
  ASSERT_EQ(json["logs"].size(), 2U);
  EXPECT_EQ(json["logs"][1]["name"], "other.csv");
  EXPECT_EQ(json["logs"][1]["rows"], 240);
  const auto& axes = json["axes"];
  const double mean = (json["logs"][0]["axes"][0]["score"].get<double>() +
                       json["logs"][1]["axes"][0]["score"].get<double>()) /
                      2.0;
  EXPECT_NEAR(axes[0]["score"].get<double>(), mean, 1e-12);
  EXPECT_GE(axes[0]["score"], axes[0]["base"]);
}

TEST_F(TuneCommand, RefusesLogsThatDoNotGoTogether) {
  write_log("other.csv", "v,n,vdot", 300, 2.0);
  EXPECT_EQ(tune("other.csv"), 2);
  EXPECT_NE(said().find("other.csv: targets: are vdot"), std::string::npos) << said();
  write_log("third.csv", "w,n,udot", 300, 2.0);
  EXPECT_EQ(tune("third.csv --set states=u --targets udot"), 2);
  EXPECT_NE(said().find("third.csv: states: 'u' is no input"), std::string::npos) << said();
  EXPECT_EQ(tune("log.csv"), 2);
  EXPECT_NE(said().find("is given twice"), std::string::npos) << said();
  EXPECT_FALSE(exists("out"));
}

TEST_F(TuneCommand, RefusesWhatContradictsItself) {
  EXPECT_EQ(tune("--set gamma=1 --search gamma=0.1:1"), 2);
  EXPECT_NE(said().find("give one of the two"), std::string::npos);
  EXPECT_EQ(tune("--only 3"), 2);
  EXPECT_NE(said().find("no configuration 3"), std::string::npos);
  EXPECT_EQ(tune("--candidates 0"), 2);
  EXPECT_FALSE(exists("out")) << "nothing is begun on a wrong command line";
}

TEST_F(TuneCommand, ATimeOfOneLogIsNoneOfTwo) {
  write_log("more.csv", "u,n,udot", 700, 0.5);
  EXPECT_EQ(tune("more.csv --since 10"), 2);
  EXPECT_NE(said().find("--since: is a time of one log"), std::string::npos) << said();
}

}  // namespace
}  // namespace kelpie::tune_test
