// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/running.hpp"
#include "support.hpp"

namespace kelpie::study_command_test {
namespace {

using nlohmann::json;
using testing::content_of;
using testing::kelpie;
using testing::little_log;
using testing::Outcome;
using testing::Running;
using testing::TemporaryFolder;
using testing::write_text;

// Learns a few hundred rows in no time.
constexpr const char* kStudy = R"(
logs = "dives/{vehicle}/{mission}.csv"
splits = "pieces"

[[learner]]
name = "small"
preset = "small"
set = {warmup = 20, buffer = 30}

[[learner]]
name = "no terms"
preset = "small"
set = {warmup = 20, buffer = 30, terms = "none"}
)";

class Study : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* const log : {"auv1/dive1", "auv1/dive2", "auv1/dive10", "auv2/dive1"}) {
      write_log(log, 300 + rows_more_++);
    }
    write_text(folder_ / "fleet.toml", kStudy);
  }

  void write_log(const std::string& name, std::size_t rows) const {
    const std::filesystem::path file = folder_ / ("dives/" + name + ".csv");
    std::filesystem::create_directories(file.parent_path());
    write_text(file, little_log(rows));
  }

  json result(const std::string& folder = "out/study") const {
    return json::parse(content_of(folder_ / folder / "study.json"));
  }

  // But for the times, which no two runs have alike.
  json without_times(const std::string& folder) const {
    json study = result(folder);
    for (json& run : study["runs"]) {
      run.erase("seconds");
      run.erase("times");
    }
    for (json& vehicle : study["vehicles"]) {
      vehicle.erase("times");
    }
    for (json& learner : study["overall"]) {
      learner.erase("times");
    }
    return study;
  }

  std::size_t lines(const std::string& file) const {
    const std::string text = content_of(folder_ / file);
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }

  void expect_refused(const std::string& arguments, const std::string& message) const {
    const Outcome outcome = kelpie(folder_.path(), "study " + arguments + " --out refused");
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << message << "\n" << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused")) << arguments;
  }

  // Of a study whose file is `text`.
  void expect_file_refused(const std::string& text, const std::string& message) const {
    write_text(folder_ / "bad.toml", text);
    expect_refused("bad.toml", message);
  }

  TemporaryFolder folder_;
  std::size_t rows_more_ = 0;
};

TEST_F(Study, HasTheFiguresOfLearnWhateverTheThreads) {
  const Outcome outcome = kelpie(folder_.path(), "study fleet.toml --threads 1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no progress bar without a terminal
  ASSERT_EQ(kelpie(folder_.path(), "study fleet.toml --threads 3 --out three").exit_code, 0);
  EXPECT_EQ(without_times("out/study").dump(), without_times("three").dump());

  const json study = result();
  ASSERT_EQ(study["runs"].size(), 8U);
  const json& run = study["runs"][3];  // dive2 comes before dive10
  EXPECT_EQ(run["log"], "dives/auv1/dive2.csv");
  EXPECT_EQ(run["mission"], "dive2");
  EXPECT_EQ(run["learner"], "no terms");
  ASSERT_EQ(kelpie(folder_.path(),
                   "learn dives/auv1/dive2.csv --split pieces --set preset=small --set warmup=20 "
                   "--set buffer=30 --set terms=none --out learn")
                .exit_code,
            0);
  const json learned = json::parse(content_of(folder_ / "learn/result.json"))["axes"][0];
  const json& axis = run["axes"][0];
  EXPECT_EQ(axis["name"], "udot");
  EXPECT_EQ(axis["r2"]["final"], learned["r2"]["final"]);
  EXPECT_EQ(axis["r2"]["mean"], learned["r2"]["mean"]);
  EXPECT_EQ(axis["r2"]["one_step"], learned["prequential_r2"]);
  EXPECT_EQ(axis["intervals"]["held"], learned["intervals"]["held"]);
  const json& baselines = learned["yardsticks"];
  EXPECT_EQ(axis["least_squares"]["final"], baselines["least_squares"]["r2_final"]);
  EXPECT_EQ(axis["mean"]["one_step"], baselines["mean"]["prequential_r2"]);
  EXPECT_EQ(axis["last_value"]["one_step"], baselines["last_value"]["prequential_r2"]);
}

TEST_F(Study, GoesOnWhereItWasStopped) {
  ASSERT_EQ(kelpie(folder_.path(), "study fleet.toml --out whole").exit_code, 0);
  write_log("auv1/dive1", 20'000);  // the largest goes first
  Running running(folder_.path(), {"study", "fleet.toml", "--threads", "1"});
  ASSERT_TRUE(running.wait_for_text("study ["));
  const Outcome second = kelpie(folder_.path(), "study fleet.toml");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_NE(second.err.find("another run is writing"), std::string::npos) << second.err;
  running.press_ctrl_c();
  EXPECT_EQ(running.exit_code(), 1);
  EXPECT_NE(running.terminal_text().find("the same command goes on from here"), std::string::npos)
      << running.terminal_text();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/study/study.json"));

  write_log("auv1/dive1", 300);
  ASSERT_EQ(kelpie(folder_.path(), "study fleet.toml").exit_code, 0);
  EXPECT_EQ(without_times("out/study").dump(), without_times("whole").dump());
}

TEST_F(Study, RunsWhatIsNewAndWhatHasChangedAlone) {
  ASSERT_EQ(kelpie(folder_.path(), "study fleet.toml").exit_code, 0);
  ASSERT_EQ(lines("out/study/journal.jsonl"), 1U + 8U);
  Outcome outcome = kelpie(folder_.path(), "study fleet.toml");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "going on with 8 of 8 runs\n");
  EXPECT_EQ(lines("out/study/journal.jsonl"), 1U + 8U);

  write_log("auv1/dive2", 350);
  write_log("auv3/dive1", 300);
  outcome = kelpie(folder_.path(), "study fleet.toml");
  EXPECT_EQ(outcome.err, "going on with 6 of 10 runs\n");
  EXPECT_EQ(lines("out/study/journal.jsonl"), 1U + 12U);
  const json study = result();
  EXPECT_EQ(study["runs"].size(), 10U);
  EXPECT_EQ(
      study["runs"][2]["training_rows"].get<int>() + study["runs"][2]["held_out_rows"].get<int>(),
      350);
}

TEST_F(Study, ALogThatCannotBeReadEndsWithOneAndIsTriedAgain) {
  write_text(folder_ / "dives/auv2/bad.csv", "t,u,udot\n0,1,a\n");
  Outcome outcome = kelpie(folder_.path(), "study fleet.toml");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("2 of 10 runs failed"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("bad.csv:2"), std::string::npos) << outcome.err;
  const json study = result();
  EXPECT_EQ(study["runs"].size(), 8U);
  ASSERT_EQ(study["failures"].size(), 2U);
  EXPECT_EQ(study["failures"][0]["log"], "dives/auv2/bad.csv");
  EXPECT_EQ(study["vehicles"][1]["failed"], 2);

  write_log("auv2/bad", 300);
  outcome = kelpie(folder_.path(), "study fleet.toml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(result()["failures"].empty());
}

TEST_F(Study, FailsWhereAVehicleHasBecomeWorse) {
  ASSERT_EQ(kelpie(folder_.path(), "study fleet.toml").exit_code, 0);
  json old = result();
  const std::string against =
      "study fleet.toml --against old.json --fail-if-worse 0.05 --out out/study";
  write_text(folder_ / "old.json", old.dump());
  EXPECT_EQ(kelpie(folder_.path(), against).exit_code, 0);
  EXPECT_EQ(result()["against"]["matched"], 8);

  // Two of three dives were better by 0.06, then by 0.04; the median counts.
  for (const double better : {0.06, 0.04}) {
    json then = old;
    for (const std::size_t i : {0U, 2U}) {
      json& r2 = then["runs"][i]["axes"][0]["r2"]["final"];
      r2 = r2.get<double>() + better;
    }
    write_text(folder_ / "old.json", then.dump());
    const Outcome outcome = kelpie(folder_.path(), against);
    EXPECT_EQ(outcome.exit_code, better > 0.05 ? 1 : 0) << outcome.err;
    const json gains = result()["against"]["gains"];
    EXPECT_EQ(gains[0]["vehicle"], "auv1");
    EXPECT_EQ(gains[0]["learner"], "small");
    EXPECT_NEAR(gains[0]["difference"]["median"].get<double>(), -better, 1e-12);
    EXPECT_EQ(gains[0]["worse"], 2);
  }
}

TEST_F(Study, LogsWhoseNamesAreNoUtf8AreLearnedEachByItself) {
  write_log("auv3/gr\xfcn", 310);
  write_log("auv3/gr\xf6n", 400);  // repaired, both are called alike
  const Outcome outcome = kelpie(folder_.path(), "study fleet.toml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json study = result();
  std::vector<int> rows;
  for (const json& run : study["runs"]) {
    if (run["vehicle"] == "auv3" && run["learner"] == "small") {
      rows.push_back(run["training_rows"].get<int>());
    }
  }
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NE(rows[0], rows[1]);
}

TEST_F(Study, RefusesWhatIsWrongInItsFile) {
  expect_refused("missing.toml", "missing.toml: cannot be read");
  expect_file_refused("logs = \"dives/*.bag\"", "bad.toml:1: logs: 'dives/*.bag' matches no file");
  expect_file_refused("splits = \"pieces\"", "logs: is missing");
  expect_file_refused("logs = \"dives/**\"", "bad.toml:1: logs: 'dives/**' may have one **");
  expect_file_refused("logs = \"{ship}/*.csv\"", "{ship} has to be {vehicle} or {mission}");
  expect_file_refused("log = \"dives\"", "bad.toml:1: log");
  expect_file_refused("logs = \"dives/*/*.csv\"\nsplit = \"tail\"", "did you mean 'splits'?");
  expect_file_refused("logs = \"dives/*/*.csv\"\nsplits = [\"peaces\"]", "bad.toml:2: splits: ");
  expect_file_refused("logs = \"dives/*/*.csv\"\nsplits = \"none\"", "holds out no rows");
  expect_file_refused("logs = \"dives/*/*.csv\"\nseeds = 0", "bad.toml:2: seeds: has to be 1 to");
  expect_file_refused("logs = \"dives/*/*.csv\"\nalign = \"soon\"", "bad.toml:2: align: has to be");
  const std::string learner = "logs = \"dives/*/*.csv\"\n[[learner]]\n";
  expect_file_refused(learner, "learner[0].name: is missing");
  expect_file_refused(learner + "name = \"mean\"", "bad.toml:3: learner[0].name: 'mean' can't be");
  expect_file_refused(learner + "name = \"a\"\nset = {gama = 1}",
                      "bad.toml:4: learner[0].set.gama: ");
  expect_file_refused(learner + "name = \"a\"\nset = {gama = 1}", "did you mean 'gamma'?");
  expect_file_refused(learner + "name = \"a\"\npreset = \"tiny\"", "bad.toml:4: learner[0].preset");
  expect_file_refused(learner + "name = \"a\"\n[[learner]]\nname = \"a\"",
                      "the name of two learners");
  const std::string vehicle = "[[vehicle]]\nlogs = \"dives/auv1/*.csv\"\n";
  expect_file_refused("align = \"none\"\n" + vehicle, "may not stand beside [[vehicle]]");
  expect_file_refused(
      vehicle + "name = \"one\"\n[[vehicle]]\nname = \"two\"\nlogs = \"dives/**/*.csv\"",
      "would be a log of one and of two");
  expect_file_refused(vehicle + "config = \"none.toml\"", "none.toml: cannot be read");
  write_text(folder_ / "vehicle.toml", "gama = 1\n");
  expect_file_refused(vehicle + "config = \"vehicle.toml\"", "vehicle.toml:1: gama: ");
}

TEST_F(Study, RefusesWhatIsWrongAroundIt) {
  expect_refused("fleet.toml --fail-if-worse 0.01", "--fail-if-worse: needs --against");
  expect_refused("fleet.toml --against none.json", "none.json");
  write_text(folder_ / "other.json", "{\"format\": \"kelpie-compare\", \"version\": 1}");
  expect_refused("fleet.toml --against other.json", "other.json: format");
  ASSERT_EQ(kelpie(folder_.path(), "study fleet.toml --out out").exit_code, 0);
  json other = result("out");
  for (json& run : other["runs"]) {
    run["learner"] = "another";
  }
  write_text(folder_ / "other.json", other.dump());
  Outcome outcome = kelpie(folder_.path(), "study fleet.toml --out out --against other.json");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("no run in common"), std::string::npos) << outcome.err;

  write_text(folder_ / "another.toml", kStudy);
  outcome = kelpie(folder_.path(), "study another.toml --out out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("journal.jsonl:1: study: this run has \"another\""), std::string::npos)
      << outcome.err;
}

TEST_F(Study, ReadsEachVehiclesLogsInItsWay) {
  write_text(folder_ / "two.toml", "gamma = 2\n[log]\ninputs = [\"n\"]\ntargets = [\"udot\"]\n");
  write_text(folder_ / "fleet.toml", R"(
name = "ways"
splits = ["random", "tail"]
seeds = 2
[[learner]]
name = "small"
preset = "small"
set = {warmup = 20, buffer = 30}
[[vehicle]]
name = "one"
logs = ["dives/**/dive1.csv"]
align = "none"
[vehicle.log]
inputs = ["u", "n"]
targets = ["udot"]
time = "t"
[[vehicle]]
logs = "dives/auv1/{mission}0.csv"
config = "two.toml"
)");
  const Outcome outcome = kelpie(folder_.path(), "study fleet.toml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json study = result();
  EXPECT_EQ(study["name"], "ways");
  ASSERT_EQ(study["runs"].size(), 3U * 3U);
  EXPECT_EQ(study["runs"][0]["vehicle"], "auv1");  // the folder, where nobody names it
  EXPECT_EQ(study["runs"][0]["mission"], "dive1");
  EXPECT_EQ(study["runs"][3]["vehicle"], "one");
  EXPECT_EQ(study["runs"][1]["seed"], 2);
  EXPECT_EQ(study["runs"][2]["split"], "tail");
  ASSERT_EQ(kelpie(folder_.path(),
                   "learn dives/auv1/dive10.csv --config two.toml --split tail --set preset=small "
                   "--set warmup=20 --set buffer=30 --out learn")
                .exit_code,
            0);
  EXPECT_EQ(study["runs"][2]["axes"][0]["r2"]["final"],
            json::parse(content_of(folder_ / "learn/result.json"))["axes"][0]["r2"]["final"]);
}

}  // namespace
}  // namespace kelpie::study_command_test
