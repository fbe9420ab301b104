// SPDX-License-Identifier: Apache-2.0
// Tables, a demonstration, and what cannot be right in messages.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/running.hpp"
#include "console/demo.hpp"
#include "console/live_command.hpp"
#include "live/mission.hpp"
#include "support.hpp"

namespace kelpie::live_tables_test {
namespace {

using testing::LiveCommand;
using testing::Outcome;
using testing::Running;
using testing::succeeded;

// Below the ports that the machine gives away by itself.
const std::string kPage = "127.0.0.1:" + std::to_string(20000 + ::getpid() % 10000);

// Exactly 10 Hz; the second and the third column are left out.
std::string log_of(std::size_t rows, const std::string& head = "t,u,n,udot") {
  const std::string text = testing::little_log(rows);
  return head + text.substr(text.find('\n'));
}

TEST_F(LiveCommand, ATableEndsWithTheModelThatLearnGivesAndNeedsNoMore) {
  write("dive.csv", log_of(2000));
  for (const std::string columns : {"", "--rate 4 --ignore t", "--units u=cm/s,udot=cm/s^2"}) {
    const Outcome outcome =
        succeeded(run("live --replay dive.csv --speed max --fresh --out out " + columns));
    EXPECT_NE(outcome.err.find("a model is in service"), std::string::npos) << outcome.err;
    succeeded(run("learn dive.csv --split none --out of_learn " + columns));
    EXPECT_FALSE(model_of("out").empty());
    EXPECT_EQ(model_of("out"), model_of("of_learn")) << columns;
  }
}

TEST_F(LiveCommand, ANewModelBeginsWithAnEarlierAsInLearn) {
  write("dive.csv", log_of(600));
  const std::string same = " --nominal first/model.json --out ";
  succeeded(run("learn dive.csv --split none --out first"));
  succeeded(run("learn dive.csv --split none" + same + "of_learn"));
  succeeded(run("live --replay dive.csv --speed max" + same + "out"));
  EXPECT_EQ(model_of("out"), model_of("of_learn"));
  EXPECT_NE(model_of("out"), model_of("first"));
  expect_refused("--replay dive.csv --fresh --nominal nothing.json --out out", "nothing.json");
  write("deep.json", "{\"more\": " + std::string(100'000, '[') + std::string(100'000, ']') + "}");
  expect_refused("--replay dive.csv --fresh --nominal deep.json --out out",
                 "deep.json: file: has more than 100 lists and objects within each other");
}

TEST_F(LiveCommand, ColumnsOfATableMayHaveAnyName) {
  write("dive.csv", log_of(600, "t,u,thruster 1 [rpm],udot"));
  succeeded(run("live --replay dive.csv --speed max --out out"));
  EXPECT_NE(content("out/model.json").find("\"thruster 1"), std::string::npos);
}

TEST_F(LiveCommand, UnitsOfTheHeaderStandInTheModel) {
  write("dive.csv", log_of(600, "t [s],u [m/s],n [rpm],udot [m/s^2]"));
  succeeded(run("live --replay dive.csv --speed max --out out"));
  succeeded(run("learn dive.csv --split none --out of_learn"));
  EXPECT_NE(model_of("out").find("\"rpm\""), std::string::npos);
  EXPECT_EQ(model_of("out"), model_of("of_learn"));
}

TEST_F(LiveCommand, ATableIsTakenUpAgainWhereItWasLeft) {
  write("dive.csv", log_of(2000));
  Running running(folder_.path(),
                  {"live", "--replay", "dive.csv", "--speed", "50", "--out", "out"});
  ASSERT_TRUE(running.wait_for_text("a model is in service")) << running.terminal_text();
  running.press_ctrl_c();
  ASSERT_EQ(running.exit_code(), 0) << running.terminal_text();
  const Outcome outcome = succeeded(run("live --replay dive.csv --speed max --out out"));
  EXPECT_NE(outcome.err.find("resuming from out/checkpoint.kelpie"), std::string::npos);
  succeeded(run("learn dive.csv --split none --out of_learn"));
  EXPECT_EQ(model_of("out"), model_of("of_learn"));
  expect_refused("--replay dive.csv --units u=cm/s,udot=cm/s^2 --out out", "log.units.u");
}

TEST_F(LiveCommand, SettingsForATableComeFromAFile) {
  write("dive.csv", log_of(600));
  write("x.toml", "buffer = 40\n[log]\ninputs = [\"u\", \"n\"]\n[live]\nalign = \"none\"\n");
  succeeded(run("live --replay dive.csv --config x.toml --speed max --out out"));
  EXPECT_EQ(parsed("out/model.json")["settings"]["buffer"], "40");
}

TEST_F(LiveCommand, WhatIsNoTableIsNamed) {
  expect_refused("--replay none.csv", "none.csv: cannot be read");
  write("dive.csv", "u,n,udot\n1,2,3\n2,3,4\n");
  expect_refused("--replay dive.csv", "name the time column with --time or give the rows per");
  expect_refused("--config x.toml --rate 4", "say what the columns of a CSV file are");
  expect_refused("--demo --replay dive.csv", "--demo");
  expect_refused("--duration 30", "--demo");
  expect_refused("--demo --duration 3", "--duration");
}

TEST_F(LiveCommand, TheDemonstrationEndsAfterItsDurationWithTheThrusterThatWasDamaged) {
  const Outcome outcome =
      succeeded(run("live --demo --speed max --page " + kPage + testing::kFewSamples));
  EXPECT_NE(outcome.err.find("kelpie: page: http://"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("the vehicle has changed: th2 gives 60"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.out.find("6000 samples learned"), std::string::npos) << outcome.out;
  EXPECT_FALSE(model_of("out/demo").empty());
}

// The drive of a day is simulated as it goes, so that its first rows are learned at once.
TEST_F(LiveCommand, ADemonstrationOfADayBeginsAtOnce) {
  const live::Configuration day = cli::demo_configuration(86'400.0, "", {});
  EXPECT_EQ(day.rows->rows(), 100U);
  const live::Configuration short_one = cli::demo_configuration(20.0, "", {});
  const std::optional<log::Dataset> next = short_one.further->next();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->rows(), 100U);
  EXPECT_EQ(next->times_s.front(), 10.1);
  EXPECT_FALSE(short_one.further->next());
}

TEST_F(LiveCommand, TheDemonstrationEndsByCtrlC) {
  Running running(folder_.path(), {"live", "--demo", "--speed", "20", "--page", kPage});
  ASSERT_TRUE(running.wait_for_text("a model is in service")) << running.terminal_text();
  running.press_ctrl_c();
  EXPECT_EQ(running.exit_code(), 0) << running.terminal_text();
  EXPECT_FALSE(model_of("out/demo").empty());
}

// A vehicle under way is not left without a model.
TEST_F(LiveCommand, TargetsThatCannotBeRightMakeTheModelDoubtful) {
  constexpr double kGravity = 9.80665;
  write("mission.mcap",
        testing::mcap_of(testing::imu_topics(), testing::little_mission(200.0, 1, 0.0, kGravity)));
  write("x.toml", testing::imu_config("align = \"none\""));
  const Outcome outcome =
      succeeded(run("live --config x.toml --replay mission.mcap --speed max --out out"));
  const std::string doubt = "udot is in g, u in m/s (udot is 0.10";
  for (const std::string& text : {outcome.err, outcome.out}) {
    EXPECT_NE(text.find(doubt), std::string::npos) << text;
  }
  EXPECT_NE(outcome.err.find("WARNING: the model is doubtful: "), std::string::npos) << outcome.err;
  EXPECT_EQ(parsed("out/model.json")["doubt"].get<std::string>().find(doubt), 0U);
  const Outcome exported = succeeded(run("export out/model.json --c model.c"));
  EXPECT_NE(exported.err.find("the model is doubtful: udot is in g"), std::string::npos)
      << exported.err;
  const Outcome again =
      succeeded(run("live --config x.toml --replay mission.mcap --speed max --out out"));
  EXPECT_NE(again.out.find(doubt), std::string::npos) << "after a restart: " << again.out;
}

TEST_F(LiveCommand, TargetsThatAreRightMakeNoDoubt) {
  write("mission.mcap",
        testing::mcap_of(testing::imu_topics(), testing::little_mission(200.0, 1, 0.0, 1.0)));
  write("x.toml", testing::imu_config("align = \"none\""));
  const Outcome outcome =
      succeeded(run("live --config x.toml --replay mission.mcap --speed max --out out"));
  EXPECT_EQ(outcome.err.find("doubtful"), std::string::npos) << outcome.err;
  EXPECT_FALSE(parsed("out/model.json").contains("doubt"));
}

TEST_F(LiveCommand, AModelOfAnImplausibleLogSaysSo) {
  write("dive.csv", log_of(1200));
  const std::string units = " --units udot=g --split none --out out";
  EXPECT_EQ(run("learn dive.csv" + units).exit_code, 2);
  succeeded(run("learn dive.csv --accept implausible" + units));
  EXPECT_NE(parsed("out/model.json")["doubt"].get<std::string>().find("times as large"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::live_tables_test
