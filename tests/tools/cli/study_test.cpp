// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/little_study.hpp"
#include "cli/running.hpp"
#include "support.hpp"

namespace kelpie::study_command_test {
namespace {

using nlohmann::json;
using testing::content_of;
using testing::kelpie;
using testing::Outcome;
using testing::Running;

class Study : public testing::CommandTest {
 protected:
  void SetUp() override { testing::write_little_study(folder_.path()); }

  void write_log(const std::string& name, std::size_t rows) const {
    testing::write_dive(folder_.path(), name, rows);
  }

  json result(const std::string& folder = "out/study") const {
    return testing::study_result(folder_ / folder);
  }

  std::string without_times(const std::string& folder) const {
    return testing::without_times(folder_ / folder);
  }

  std::size_t lines(const std::string& file) const {
    const std::string text = content(file);
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }

  void expect_refused(const std::string& arguments, const std::string& message) const {
    expect_nothing_written("study " + arguments, message);
  }

  // Of a study whose file is `text`.
  void expect_file_refused(const std::string& text, const std::string& message) const {
    write("bad.toml", text);
    expect_refused("bad.toml", message);
  }
};

TEST_F(Study, HasTheFiguresOfLearnWhateverTheThreads) {
  const Outcome outcome = run("study fleet.toml --threads 1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");  // no progress bar without a terminal
  EXPECT_NE(outcome.out.find("\nvehicles: no cause of a change was found\n"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("\nnext:   kelpie study fleet.toml"), std::string::npos);
  testing::write_little_study(folder_ / "my fleet");
  const Outcome spaces = run("study 'my fleet/fleet.toml' --out 'my out'");
  EXPECT_NE(spaces.out.find(
                "kelpie study 'my fleet/fleet.toml' --out FOLDER --against 'my out/study.json'"),
            std::string::npos)
      << spaces.out << spaces.err;
  EXPECT_EQ(outcome.out.find("Learners, over all vehicles"), std::string::npos);
  ASSERT_EQ(run("study fleet.toml --threads 3 --out three").exit_code, 0);
  EXPECT_EQ(without_times("out/study"), without_times("three"));

  const json study = result();
  ASSERT_EQ(study["runs"].size(), 8U);
  const json& fourth = study["runs"][3];  // dive2 comes before dive10
  EXPECT_EQ(fourth["log"], "dives/auv1/dive2.csv");
  EXPECT_EQ(fourth["mission"], "dive2");
  EXPECT_EQ(fourth["learner"], "no terms");
  ASSERT_EQ(run("learn dives/auv1/dive2.csv --split pieces --set preset=small --set warmup=20 "
                "--set buffer=30 --set terms=none --out learn")
                .exit_code,
            0);
  const json learned = parsed("learn/result.json")["axes"][0];
  const json& axis = fourth["axes"][0];
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
  ASSERT_EQ(run("study fleet.toml --out whole").exit_code, 0);
  write_log("auv1/dive1", 20'000);  // the largest goes first
  Running running(folder_.path(), {"study", "fleet.toml", "--threads", "1"});
  ASSERT_TRUE(running.wait_for_text("study ["));
  const Outcome second = run("study fleet.toml");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_NE(second.err.find("another run is writing"), std::string::npos) << second.err;
  running.press_ctrl_c();
  EXPECT_EQ(running.exit_code(), 1);
  EXPECT_NE(running.terminal_text().find("the same command goes on from here"), std::string::npos)
      << running.terminal_text();
  EXPECT_FALSE(exists("out/study/study.json"));

  write_log("auv1/dive1", 300);
  ASSERT_EQ(run("study fleet.toml").exit_code, 0);
  EXPECT_EQ(without_times("out/study"), without_times("whole"));
}

TEST_F(Study, RunsWhatIsNewAndWhatHasChangedAlone) {
  ASSERT_EQ(run("study fleet.toml").exit_code, 0);
  ASSERT_EQ(lines("out/study/journal.jsonl"), 1U + 8U);
  Outcome outcome = run("study fleet.toml");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "going on with 8 of 8 runs\n");
  EXPECT_EQ(lines("out/study/journal.jsonl"), 1U + 8U);

  write_log("auv1/dive2", 350);
  write_log("auv3/dive1", 300);
  outcome = run("study fleet.toml");
  EXPECT_EQ(outcome.err, "going on with 6 of 10 runs\n");
  EXPECT_EQ(lines("out/study/journal.jsonl"), 1U + 12U);
  const json study = result();
  EXPECT_EQ(study["runs"].size(), 10U);
  EXPECT_EQ(
      study["runs"][2]["training_rows"].get<int>() + study["runs"][2]["held_out_rows"].get<int>(),
      350);
}

TEST_F(Study, ALogThatCannotBeReadEndsWithOneAndIsTriedAgain) {
  write("dives/auv2/bad.csv", "t,u,udot\n0,1,a\n");
  Outcome outcome = run("study fleet.toml");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("2 of 10 runs failed"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("bad.csv:2"), std::string::npos) << outcome.err;
  const json study = result();
  EXPECT_EQ(study["runs"].size(), 8U);
  ASSERT_EQ(study["failures"].size(), 2U);
  EXPECT_EQ(study["failures"][0]["log"], "dives/auv2/bad.csv");
  EXPECT_EQ(study["vehicles"][1]["failed"], 2);

  write_log("auv2/bad", 300);
  outcome = run("study fleet.toml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(result()["failures"].empty());
}

TEST_F(Study, FailsWhereAVehicleHasBecomeWorse) {
  ASSERT_EQ(run("study fleet.toml").exit_code, 0);
  const json old = result();
  const std::string against =
      "study fleet.toml --against old.json --fail-if-worse 0.05 --out out/study";
  write("old.json", old.dump());
  EXPECT_EQ(run(against).exit_code, 0);
  EXPECT_EQ(result()["against"]["matched"], 8);

  // Two of three dives were better by 0.06, then by 0.04; the median counts.
  for (const double better : {0.06, 0.04}) {
    json then = old;
    for (const std::size_t i : {0U, 2U}) {
      json& r2 = then["runs"][i]["axes"][0]["r2"]["final"];
      r2 = r2.get<double>() + better;
    }
    write("old.json", then.dump());
    const Outcome outcome = run(against);
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
  const Outcome outcome = run("study fleet.toml");
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
  expect_file_refused("logs = \"dives/*/*.csv\"\nalign = \"soon\"",
                      "bad.toml:2: align: 'soon' is not known");
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
  write("vehicle.toml", "gama = 1\n");
  expect_file_refused(vehicle + "config = \"vehicle.toml\"", "vehicle.toml:1: gama: ");
}

TEST_F(Study, RefusesWhatIsWrongAroundIt) {
  expect_refused("fleet.toml --fail-if-worse 0.01", "--fail-if-worse: needs --against");
  expect_refused("fleet.toml --against none.json", "none.json");
  write("other.json", R"({"format": "kelpie-compare", "version": 1})");
  expect_refused("fleet.toml --against other.json", "other.json: format");
  ASSERT_EQ(run("study fleet.toml --out out").exit_code, 0);
  json other = result("out");
  for (json& run : other["runs"]) {
    run["learner"] = "another";
  }
  write("other.json", other.dump());
  Outcome outcome = run("study fleet.toml --out out --against other.json");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("no run in common"), std::string::npos) << outcome.err;

  write("another.toml", testing::kLittleStudy);
  outcome = run("study another.toml --out out");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("journal.jsonl:1: study: this run has \"another\""), std::string::npos)
      << outcome.err;
}

TEST_F(Study, ReadsEachVehiclesLogsInItsWay) {
  write("two.toml", "gamma = 2\n[log]\ninputs = [\"n\"]\ntargets = [\"udot\"]\n");
  write("fleet.toml", R"(
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
  const Outcome outcome = run("study fleet.toml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json study = result();
  EXPECT_EQ(study["name"], "ways");
  ASSERT_EQ(study["runs"].size(), 3U * 3U);
  EXPECT_EQ(study["runs"][0]["vehicle"], "auv1");  // the folder, where nobody names it
  EXPECT_EQ(study["runs"][0]["mission"], "dive1");
  EXPECT_EQ(study["runs"][3]["vehicle"], "one");
  EXPECT_EQ(study["runs"][1]["seed"], 2);
  EXPECT_EQ(study["runs"][2]["split"], "tail");
  ASSERT_EQ(run("learn dives/auv1/dive10.csv --config two.toml --split tail --set preset=small "
                "--set warmup=20 --set buffer=30 --out learn")
                .exit_code,
            0);
  EXPECT_EQ(study["runs"][2]["axes"][0]["r2"]["final"],
            parsed("learn/result.json")["axes"][0]["r2"]["final"]);
}

TEST_F(Study, ThreePartsMergedAreTheStudyOfOneProcess) {
  ASSERT_EQ(run("study fleet.toml --out whole").exit_code, 0);
  for (const char* const part : {"2/3", "1/3", "3/3"}) {
    const Outcome outcome = run(std::string("study fleet.toml --out parts --part ") + part);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(std::string("part ") + part + ": "), std::string::npos)
        << outcome.out;
    EXPECT_FALSE(exists("parts/study.json"));
  }
  std::size_t runs = 0;
  for (const char* const part : {"1", "2", "3"}) {
    const std::size_t own = lines(std::string("parts/journal.part-") + part + "-of-3.jsonl") - 1;
    EXPECT_GE(own, 2U);  // 8 runs of about the same cost
    runs += own;
  }
  EXPECT_EQ(runs, 8U);
  EXPECT_FALSE(exists("parts/journal.jsonl"));

  const Outcome merged = run("study fleet.toml --out parts --merge");
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(without_times("parts"), without_times("whole"));
  // With the same times, whichever way the journals are read.
  const std::string bytes = content("parts/study.json");
  const Outcome whole = run("study fleet.toml --out parts");
  EXPECT_EQ(whole.err, "going on with 8 of 8 runs\n");
  EXPECT_EQ(content("parts/study.json"), bytes);
}

TEST_F(Study, AMergeNamesThePartsThatAreMissingAndWritesNothing) {
  ASSERT_EQ(run("study fleet.toml --part 1/3").exit_code, 0);
  ASSERT_EQ(run("study fleet.toml --part 3/3").exit_code, 0);
  Outcome outcome = run("study fleet.toml --merge");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("of 8 runs are missing, so nothing was written; run these parts "
                             "again: --part 2/3 ("),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.err.find("1/3"), std::string::npos) << outcome.err;
  EXPECT_FALSE(exists("out/study/study.json"));
  ASSERT_EQ(run("study fleet.toml --part 2/3").exit_code, 0);
  EXPECT_EQ(run("study fleet.toml --merge").exit_code, 0);

  outcome = run("study fleet.toml --merge --out none");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("8 of 8 runs are missing"), std::string::npos) << outcome.err;
  EXPECT_FALSE(exists("none"));
}

TEST_F(Study, AKilledPartGoesOnFromItsJournal) {
  ASSERT_EQ(run("study fleet.toml --out whole").exit_code, 0);
  write_log("auv1/dive1", 20'000);  // the largest goes first: both its runs, a part each
  const std::string journal = "out/study/journal.part-1-of-2.jsonl";
  Running running(folder_.path(), {"study", "fleet.toml", "--part", "1/2", "--threads", "2"});
  ASSERT_TRUE(running.wait_until([&] { return lines(journal) >= 1U + 2U; }));
  const Outcome second = run("study fleet.toml --part 1/2");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_NE(second.err.find("another run is writing"), std::string::npos) << second.err;
  running.kill();
  const std::string before = content_of(folder_ / journal);

  write_log("auv1/dive1", 300);
  const Outcome first = run("study fleet.toml --part 1/2");
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(first.err.starts_with("going on with ")) << first.err;
  EXPECT_TRUE(content_of(folder_ / journal).starts_with(before));
  ASSERT_EQ(run("study fleet.toml --part 2/2").exit_code, 0);
  ASSERT_EQ(run("study fleet.toml --merge").exit_code, 0);
  EXPECT_EQ(without_times("out/study"), without_times("whole"));
}

TEST_F(Study, AMergeTellsOfRunsThatFailedInTheirParts) {
  write("dives/auv2/bad.csv", "t,u,udot\n0,1,a\n");
  EXPECT_EQ(run("study fleet.toml --out whole").exit_code, 1);
  int failed = 0;
  for (const char* const part : {"1/2", "2/2"}) {
    failed += run(std::string("study fleet.toml --part ") + part).exit_code;
  }
  EXPECT_GE(failed, 1);
  Outcome merged = run("study fleet.toml --merge");
  EXPECT_EQ(merged.exit_code, 1);
  EXPECT_NE(merged.err.find("2 of 10 runs failed, the first of them: dives/auv2/bad.csv:2"),
            std::string::npos)
      << merged.err;
  EXPECT_EQ(without_times("out/study"), without_times("whole"));

  write_log("auv2/bad", 300);  // tried again, in other parts
  for (const char* const part : {"1/3", "2/3", "3/3"}) {
    EXPECT_EQ(run(std::string("study fleet.toml --part ") + part).exit_code, 0);
  }
  merged = run("study fleet.toml --merge");
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_TRUE(result()["failures"].empty());
}

TEST_F(Study, RefusesPartsThatDoNotExist) {
  for (const char* const part : {"0/3", "4/3", "x", "1/0", "1/", "-1/3", "1/3x"}) {
    expect_refused(std::string("fleet.toml --part=") + part,
                   "--part: has to be k/n with 1 <= k <= n");
  }
  expect_refused("fleet.toml --part 1/3 --merge", "--merge");
  expect_refused("fleet.toml --part 1/3 --against old.json", "--against");
}

// Every process would do the whole study; parts are for several processes.
TEST_F(Study, RefusesProcessesThatMpirunHasStarted) {
  ::setenv("OMPI_COMM_WORLD_SIZE", "3", 1);  // NOLINT(concurrency-mt-unsafe): no other thread
  expect_refused("fleet.toml", "mpirun: has started 3 processes");
  expect_refused("fleet.toml", "kelpie study --part k/n");
  const Outcome part = kelpie(folder_.path(), "study fleet.toml --part 1/3 --out parts");
  ::unsetenv("OMPI_COMM_WORLD_SIZE");  // NOLINT(concurrency-mt-unsafe): the same
  EXPECT_EQ(part.exit_code, 0) << part.err;
}

}  // namespace
}  // namespace kelpie::study_command_test
