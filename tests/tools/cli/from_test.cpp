// SPDX-License-Identifier: Apache-2.0
// Runs that go on with the model of an earlier one, and logs that are learned in a row.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.hpp"

namespace kelpie::from_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::content_of;
using testing::kelpie;
using testing::little_log;
using testing::Outcome;

constexpr std::size_t kRows = 1600;

// Rows from..to of a log, its header first.
std::string part_of(const std::string& log, std::size_t from, std::size_t to) {
  std::string part;
  std::size_t row = 0;
  std::size_t at = 0;
  while (at < log.size()) {
    const std::size_t end = log.find('\n', at) + 1;
    if (row == 0 || (row > from && row <= to)) {
      part += log.substr(at, end - at);
    }
    at = end;
    ++row;
  }
  return part;
}

class From : public testing::CommandTest {
 protected:
  From() {
    const std::string log = little_log(kRows);
    write("whole.csv", log);
    write("monday.csv", part_of(log, 0, kRows / 2));
    write("tuesday.csv", part_of(log, kRows / 2, kRows));
  }

  Outcome learn(const std::string& arguments) const { return run("learn " + arguments); }
  void expect_learned(const std::string& arguments) const {
    const Outcome outcome = learn(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
  }
  void expect_refused(const std::string& arguments, const std::string& message) const {
    testing::expect_refused(learn(arguments), message);
  }
  Json result(const std::string& out) const {
    return Json::parse(content_of(folder_ / out / "result.json"));
  }
  // R² on held-out rows 90 samples into the log.
  double early_r2(const std::string& out) const {
    const Json validation = result(out)["axes"][0]["validation"];
    for (std::size_t i = 0; i < validation["samples"].size(); ++i) {
      if (validation["samples"][i] == 90) {
        return validation["r2"][i].get<double>();
      }
    }
    return -1e9;
  }
};

TEST_F(From, BothFilesGoOnUnderAnotherLog) {
  const std::string set = " --set buffer=100 --split tail --validate-every 30";
  expect_learned("monday.csv --out monday --checkpoint-every 300" + set);
  expect_learned("tuesday.csv --out alone" + set);
  for (const std::string file : {"model.json", "checkpoint.kelpie"}) {
    expect_learned("tuesday.csv --out next --split tail --validate-every 30 --from monday/" + file);
    EXPECT_EQ(result("next")["from"], "monday/" + file);
    EXPECT_EQ(result("next")["settings"]["buffer"], 100);
    EXPECT_LT(1.0 - early_r2("next"), 0.5 * (1.0 - early_r2("alone"))) << file;
    EXPECT_TRUE(exists("next/model.json"));
  }
  EXPECT_TRUE(result("alone")["from"].is_null());
}

TEST_F(From, AChainOfCheckpointsHoldsAllOfIt) {
  expect_learned("monday.csv --out a --checkpoint-every 300 --split tail");
  expect_learned(
      "tuesday.csv --out b --checkpoint-every 300 --split tail --from a/checkpoint.kelpie");
  const Json tally = result("b")["axes"][0]["decisions"];
  EXPECT_GT(tally["accepted"].get<int>() + tally["gate_explained"].get<int>(),
            result("b")["samples_shown"].get<int>());
  expect_learned("tuesday.csv --out c --split tail --from b/checkpoint.kelpie --resume");
}

TEST_F(From, ARunThatGoesOnCanBeResumed) {
  expect_learned("monday.csv --out monday --split tail");
  const std::string run =
      "tuesday.csv --split tail --from monday/model.json --checkpoint-every 200";
  expect_learned(run + " --out whole");
  expect_learned(run + " --out cut");
  fs::rename(folder_ / "cut/checkpoint.previous.kelpie", folder_ / "cut/checkpoint.kelpie");
  expect_learned(run + " --out cut --resume");
  EXPECT_EQ(content("cut/model.json"), content("whole/model.json"));
}

TEST_F(From, WhatCannotGoOnIsRefused) {
  expect_learned("monday.csv --out monday --checkpoint-every 300 --split tail");
  const std::string model = "tuesday.csv --from monday/model.json ";
  const std::string checkpoint = "tuesday.csv --from monday/checkpoint.kelpie ";
  expect_refused("tuesday.csv --from nowhere.json", "nowhere.json");
  expect_refused("tuesday.csv --from monday", "is a folder; name the model.json");
  expect_refused("tuesday.csv --from tuesday.csv", "tuesday.csv");
  expect_refused(model + "--inputs u", "--inputs: are u; monday/model.json is a model of u,n");
  expect_refused(model + "--scales train", "--scales: is fixed by the model of --from");
  expect_refused(model + "--memory m.json", "--memory: ");
  expect_refused(model + "--split tail --set terms=none", "terms: give 0 physics terms");
  expect_refused(model + "--set preset=paper", "preset: 'paper' is another");
  expect_refused(checkpoint + "--split tail --set gamma=0.3", "monday/checkpoint.kelpie: gamma: ");
  write("other.csv", "t,a,b,adot\n0,1,2,3\n1,2,3,1\n2,4,1,1\n");
  expect_refused("other.csv --from monday/model.json", "other.csv");
}

TEST_F(From, LogsInARowAreOneLog) {
  expect_learned("whole.csv --out whole --split tail --align none");
  expect_learned("monday.csv tuesday.csv --out both --split tail --align none");
  EXPECT_EQ(result("both")["dataset"]["path"], "monday.csv, tuesday.csv");
  EXPECT_EQ(result("both")["samples_shown"], result("whole")["samples_shown"]);
  // The clock goes on from one file to the next: the very same samples.
  Json both = parsed("both/model.json");
  Json whole = parsed("whole/model.json");
  EXPECT_EQ(both["learned"].size(), 2U);
  EXPECT_EQ(whole["learned"].size(), 1U);
  both.erase("learned");
  whole.erase("learned");
  EXPECT_EQ(both, whole);
}

TEST_F(From, ALogWhoseClockBeginsAgainFollowsAMinuteLater) {
  expect_learned("monday.csv monday.csv --out twice --split tail");
  const Json validation = result("twice")["axes"][0]["validation"];
  const double last = validation["time_s"].back().get<double>();
  EXPECT_GT(last, 60.0 + result("twice")["dataset"]["rate_hz"].get<double>());
  write("other.csv", "t,u,m,udot\n0,1,2,3\n1,2,3,1\n2,4,1,1\n");
  expect_refused("monday.csv other.csv --out x", "other.csv");
}

TEST_F(From, WhatItGoesOnFromIsNotReplaced) {
  expect_learned("monday.csv --split tail");
  expect_refused(
      "tuesday.csv --split tail --from out/learn/model.json",
      "out/learn/model.json: --from: would be overwritten by the new model; choose another "
      "folder, as in --out out/learn_next");
  expect_learned("tuesday.csv --split tail --from out/learn/model.json --out out/learn_next");
}

TEST_F(From, PredictTellsRowsOfEveryLogThatWasLearned) {
  expect_learned("monday.csv tuesday.csv --split tail --out both");
  expect_learned("monday.csv --split tail --out first");
  expect_learned("tuesday.csv --split none --from first/model.json --out then");
  expect_learned("monday.csv --split none --from first/model.json --out again");
  const auto said = [&](const std::string& model, const std::string& log) {
    return run("predict --model " + model + "/model.json " + log).out;
  };
  EXPECT_NE(said("both", "monday.csv").find("over 800 rows that it learned"), std::string::npos);
  EXPECT_NE(said("both", "tuesday.csv").find("over 320 rows held out"), std::string::npos);
  EXPECT_NE(said("then", "monday.csv").find("over 160 rows held out"), std::string::npos);
  EXPECT_NE(said("then", "tuesday.csv").find("over 800 rows that it learned"), std::string::npos);
  EXPECT_NE(said("again", "monday.csv").find("over 800 rows that it learned"), std::string::npos);
  EXPECT_NE(said("again", "tuesday.csv").find("over 800 of 800 rows"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::from_test
