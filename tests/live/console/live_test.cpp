// SPDX-License-Identifier: Apache-2.0
// KELPIE_KILLS says how often to kill (default 12):
// KELPIE_KILLS=200 build/release/test_cli --gtest_filter=LiveCommand.*Killed*
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "bag/ardusub_drive.hpp"
#include "cli/running.hpp"
#include "console/live_command.hpp"
#include "format/checkpoint_file.hpp"
#include "kelpie/core/random.hpp"
#include "live/mission.hpp"
#include "support.hpp"

namespace kelpie::live_test {
namespace {

namespace fs = std::filesystem;
using testing::Listener;
using testing::little_mission;
using testing::LiveCommand;
using testing::mission_config;
using testing::mission_topics;
using testing::Outcome;
using testing::read_text;
using testing::Running;

// Two models are the same, or not, with few samples as with many.
const std::string kSmall = "buffer = 60\nanchors = 20\n";

TEST_F(LiveCommand, EndsWithTheModelThatLearnGives) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "none"},
      {"clock = \"header\"", "auto"},
      {"clock = \"header\"\nlag = 0.07\nfilter = \"causal\"\ngap = 0.5", "0.2"},
      {"lag = {u = 0.013, n = -0.05}\nwindow = 1.0", "-0.3"},
  };
  for (const auto& [log, align] : cases) {
    const bool is_number = align != "auto" && align != "none";
    write_mission(200.0,
                  mission_config(log, "align = " + (is_number ? align : "\"" + align + "\"")));
    const Outcome outcome = live("--speed max --fresh --out out");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_model_of_learn("out", align);
  }
}

TEST_F(LiveCommand, ASignalThatEndsBeforeTheLogIsTold) {
  constexpr std::int64_t kEnd = (1'700'000'000 + 40) * testing::kSecond;
  std::vector<testing::Recorded> messages = little_mission(60.0);
  std::erase_if(messages, [&](const auto& m) { return m.topic == 1 && m.receive_ns >= kEnd; });
  write("mission.mcap", testing::mcap_of(testing::mission_topics(), messages));
  write("x.toml", mission_config("clock = \"header\"", "align = \"none\""));
  const Outcome outcome = live("--speed max --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("ends 20 s before the log"), std::string::npos) << outcome.out;
  std::smatch rows;
  ASSERT_TRUE(std::regex_search(outcome.out, rows, std::regex("(\\d+) rows with a value missing")))
      << outcome.out;
  EXPECT_NEAR(std::stod(rows[1]), 200.0, 5.0);
  const std::string why = "no row has been whole for 10 s: n is silent";
  EXPECT_NE(outcome.out.find(why), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
  expect_model_of_learn("out", "none");
}

TEST_F(LiveCommand, FindsTheShiftOfItsCommandsAsLearnDoes) {
  write_mission(400.0, mission_config("clock = \"header\"\nlag = -0.5"));
  const Outcome outcome = testing::succeeded(live("--speed max --out out"));
  EXPECT_NE(outcome.err.find("commands are taken"), std::string::npos) << outcome.err;
  expect_model_of_learn("out");
}

TEST_F(LiveCommand, FindsTheActuatorsOfItsCommandsAsLearnDoes) {
  write("mission.mcap", testing::mcap_of(mission_topics(), little_mission(400.0, 1, 1.5)));
  write("x.toml", mission_config("clock = \"header\""));
  const Outcome outcome = testing::succeeded(live("--speed max --out out"));
  EXPECT_NE(outcome.err.find("follows its command in"), std::string::npos) << outcome.err;
  expect_model_of_learn("out");
  EXPECT_NE(model_of("out").find("\"lag_s\""), std::string::npos);
  testing::succeeded(live("--speed max --out out"));  // goes on with its checkpoint
  expect_model_of_learn("out");
}

TEST_F(LiveCommand, TakesWhatIsKnownOfActuatorsAsLearnDoes) {
  for (const std::string align : {"none", "0.2", "auto"}) {
    const std::string wish = align == "0.2" ? align : "\"" + align + "\"";
    write_mission(200.0, mission_config("actuators = {n = {neutral = 1.5, dead_band = 0.5}}",
                                        "align = " + wish));
    testing::succeeded(live("--speed max --fresh --out out"));
    EXPECT_NE(model_of("out").find("\"neutral\": 1.5"), std::string::npos) << model_of("out");
    expect_model_of_learn("out", align);
  }
  write_mission(20.0, mission_config("actuators = {n = {neutral = 2}}", "align = \"auto\""));
  expect_refused("--config x.toml --from mission.mcap --speed max --out out", "log.actuators.n");
}

TEST_F(LiveCommand, ARealMissionEndsWithTheModelThatLearnGives) {
  const fs::path bag = testing::data_file("flatfish_bag");
  if (bag.empty()) {
    GTEST_SKIP() << "no data";
  }
  std::string config = read_text(fs::path(KELPIE_SOURCE_DIR) / "examples" / "flatfish.toml");
  for (std::size_t at = config.find("\"auto\""); at != std::string::npos;
       at = config.find("\"auto\"")) {
    config.replace(at, 6, "0.008");
  }
  const std::string messages = (fs::path(KELPIE_SOURCE_DIR) / "examples" / "msg").string();
  config.replace(config.find("\"msg\""), 5, "\"" + messages + "\"");
  write("x.toml", kSmall + config + "\n[live]\nfrozen = \"learn\"\n");
  const Outcome outcome = testing::succeeded(
      run("live --config x.toml --from '" + bag.string() + "' --speed max --out out"));
  expect_model_of_learn("out", "auto", "'" + bag.string() + "'");
}

TEST_F(LiveCommand, LogsOfAutopilotsEndWithTheModelThatLearnGives) {
  for (const char* const name : {"px4_small.ulg", "ardusub_small.BIN"}) {
    const fs::path log = testing::data_file(fs::path("logs") / name);
    if (log.empty()) {
      GTEST_SKIP() << "no data";
    }
    testing::succeeded(run("inspect '" + log.string() + "' --template x.toml"));
    write("x.toml", kSmall + content("x.toml"));
    const Outcome outcome =
        run("live --config x.toml --from '" + log.string() + "' --speed max --fresh --out out");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_model_of_learn("out", "auto", "'" + log.string() + "'");
    EXPECT_NE(outcome.err.find("--from of `kelpie live` is called --replay"), std::string::npos);
    const Outcome drafted =
        testing::succeeded(run("live --replay '" + log.string() +
                               "' --speed max --fresh --out drafted" + testing::kFewSamples));
    EXPECT_EQ(model_of("drafted"), model_of("out"));
    EXPECT_NE(drafted.out.find("taken by types and names"), std::string::npos) << drafted.out;
    fs::remove(folder_ / "x.toml");
  }
}

// Armed for a while only, with parameters that reverse a motor.
TEST_F(LiveCommand, ADriveOfArdusubEndsWithTheModelThatLearnGives) {
  write("drive.tlog", testing::ArdusubDrive::tlog().text());
  write("drive.BIN", testing::ArdusubDrive::bin());
  for (const std::string name : {"drive.tlog", "drive.BIN"}) {
    testing::succeeded(run("inspect " + name + " --template x.toml"));
    write("x.toml", kSmall + content("x.toml"));
    testing::succeeded(
        run("live --config x.toml --from " + name + " --speed max --fresh --out out"));
    expect_model_of_learn("out", "auto", name);
    fs::remove(folder_ / "x.toml");
  }
}

// With the deltas of a velocity log, and motors mirrored as the parameters tell.
TEST_F(LiveCommand, DeltasAndDirectionsOfArdusubAreTheSameAsInLearn) {
  write("drive.tlog", testing::ArdusubDrive::tlog(true).text());
  write("drive.BIN", testing::ArdusubDrive::bin(true));
  for (const std::string name : {"drive.tlog", "drive.BIN"}) {
    testing::succeeded(run("inspect " + name + " --template x.toml"));
    std::string config = content("x.toml");
    const std::string by_hand = "m2 = {by = -1, about = 1500}";
    ASSERT_NE(config.find(by_hand), std::string::npos) << config;
    config.replace(config.find(by_hand), by_hand.size(), "");
    config.replace(config.find("[log]\n"), 6, "[log]\nmirror_motors = true\n");
    write("x.toml", kSmall + config);
    testing::succeeded(
        run("live --config x.toml --from " + name + " --speed max --fresh --out out"));
    expect_model_of_learn("out", "auto", name);
    const std::string mirrored = model_of("out");
    fs::remove(folder_ / "x.toml");
    testing::succeeded(
        run("live --replay " + name + " --speed max --fresh --out drafted" + testing::kFewSamples));
    EXPECT_EQ(model_of("drafted"), mirrored);
  }
}

// Its times count from where it begins, not from 1970: nothing is lost, and as much is kept.
TEST_F(LiveCommand, ARecordingWhoseClockWentTo1970IsLearnedAsIfFromAVehicle) {
  constexpr std::int64_t kBegin = 1'700'000'000 * testing::kSecond;
  std::vector<testing::Recorded> messages = little_mission(120.0);
  for (testing::Recorded& message : messages) {
    const std::int64_t after_ns = message.receive_ns - kBegin;
    if (message.topic < 2 && after_ns > 40 * testing::kSecond && after_ns < 50 * testing::kSecond) {
      const auto bytes = testing::twist_at(after_ns, 0.1);
      std::copy_n(bytes.begin(), 12, message.data.begin());
    }
  }
  write("mission.mcap", testing::mcap_of(mission_topics(), messages));
  write("x.toml", mission_config("clock = \"header\""));
  const Outcome outcome = testing::succeeded(live("--speed max --out out"));
  EXPECT_NE(outcome.out.find("1 times a clock"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("at 1."), std::string::npos) << outcome.err;  // s: a model in service
  const std::size_t count = outcome.out.find(" samples learned");
  ASSERT_NE(count, std::string::npos) << outcome.out;
  const std::size_t line = outcome.out.rfind('\n', count) + 1;
  EXPECT_GT(std::stoi(outcome.out.substr(line)), 1160);
}

// Paced by the times of reception, it would wait for a year.
TEST_F(LiveCommand, ARecorderWhoseClockWasAYearAheadForThreeMessagesIsReplayedWithoutAWait) {
  write("x.toml", mission_config("clock = \"header\"", "align = \"none\""));
  std::vector<testing::Recorded> messages = little_mission(60.0);
  for (std::size_t i = 500; i < 503; ++i) {
    messages[i].receive_ns += 365LL * 86'400 * testing::kSecond;
  }
  write("mission.mcap", mcap_of(mission_topics(), messages));
  const Outcome outcome = live("--speed 100 --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(model_of("out").empty());
}

TEST_F(LiveCommand, WhatItRecordsIsLearnedToTheSameModel) {
  write_mission(120.0);
  ASSERT_EQ(live("--speed max --out out --record rec").exit_code, 0);
  expect_model_of_learn("out", "auto", "rec/live_0001.mcap");
}

TEST_F(LiveCommand, KilledAnywhereItGoesOnAndLosesNoMoreThanItSays) {
  const char* const wish = std::getenv("KELPIE_KILLS");  // NOLINT: no thread writes it
  const int kills = wish == nullptr ? 12 : std::stoi(wish);
  constexpr double kCheckpointS = 5.0;
  write_mission(300.0, mission_config("clock = \"header\"", "checkpoint = 5"));
  const Listener listener;
  RandomStream random(3, "kills");
  double last_s = 0.0;
  int killed = 0;
  int rounds = 0;
  while (killed < kills) {
    const std::string out = "out" + std::to_string(rounds);
    Running running(folder_.path(),
                    {"live", "--config", "x.toml", "--from", "mission.mcap", "--speed", "200",
                     "--out", out, "--plotjuggler", listener.port()});
    std::this_thread::sleep_for(std::chrono::duration<double>(random.uniform(0.0, 0.6)));
    const int code = running.kill();
    const std::vector<double> learned = listener.learned();
    if (last_s > 0.0 && !learned.empty()) {
      EXPECT_GE(learned.front(), last_s - kCheckpointS - 0.2);
    }
    if (!learned.empty()) {
      last_s = learned.back();
    }
    if (code == -SIGKILL) {
      ++killed;
      continue;
    }
    ASSERT_EQ(code, 0) << running.terminal_text();  // it had ended already
    ++rounds;
    last_s = 0.0;
  }
  const Outcome outcome =
      testing::succeeded(live("--speed max --out out" + std::to_string(rounds)));
  expect_model_of_learn("out" + std::to_string(rounds));
}

TEST_F(LiveCommand, StoppedItSavesAndGoesOn) {
  write_mission(120.0);
  Running running(folder_.path(), {"live", "--config", "x.toml", "--from", "mission.mcap",
                                   "--speed", "20", "--out", "out"});
  ASSERT_TRUE(running.wait_for_text("a model is in service")) << running.terminal_text();
  running.send(SIGTERM);
  ASSERT_EQ(running.exit_code(), 0) << running.terminal_text();
  EXPECT_FALSE(model_of("out").empty());
  const Outcome outcome = testing::succeeded(live("--speed max --out out"));
  EXPECT_NE(outcome.err.find("resuming from out/checkpoint.kelpie"), std::string::npos);
  expect_model_of_learn("out");
  // Once more, when all is learned already.
  ASSERT_EQ(live("--speed max --out out").exit_code, 0);
  expect_model_of_learn("out");
}

TEST_F(LiveCommand, FrozenBySignalsAndOptionsItStaysSoUntilResumed) {
  write_mission(120.0, mission_config("", "align = \"none\""));
  Running running(folder_.path(), {"live", "--config", "x.toml", "--from", "mission.mcap",
                                   "--speed", "20", "--out", "out"});
  ASSERT_TRUE(running.wait_for_text("a model is in service")) << running.terminal_text();
  running.send(SIGUSR1);
  ASSERT_TRUE(running.wait_for_text("learning is frozen")) << running.terminal_text();
  running.send(SIGUSR2);
  ASSERT_TRUE(running.wait_for_text("learning goes on")) << running.terminal_text();
  running.send(SIGTERM);
  ASSERT_EQ(running.exit_code(), 0) << running.terminal_text();
  const std::string model = model_of("out");
  const Outcome frozen = testing::succeeded(live("--speed max --out out --freeze"));
  EXPECT_NE(frozen.out.find("rows while learning was frozen, not learned"), std::string::npos)
      << frozen.out;
  EXPECT_EQ(model_of("out"), model);
  const Outcome still = live("--speed max --out out");
  EXPECT_NE(still.err.find("learning is frozen, as it was before"), std::string::npos) << still.err;
  EXPECT_EQ(model_of("out"), model);
  // Another recording is learned.
  write("mission.mcap", testing::mcap_of(mission_topics(), little_mission(60.0, 2)));
  const Outcome resumed = live("--speed max --out out --resume");
  EXPECT_NE(resumed.err.find("learning goes on"), std::string::npos) << resumed.err;
  EXPECT_NE(model_of("out"), model);
  expect_refused("--config x.toml --from mission.mcap --freeze --resume", "--resume");
}

TEST_F(LiveCommand, AHangupReadsTheConfigurationAnew) {
  write_mission(120.0, mission_config("", "out = \"out\""));
  const Listener listener;
  Running running(folder_.path(),
                  {"live", "--config", "x.toml", "--from", "mission.mcap", "--speed", "10"});
  ASSERT_TRUE(running.wait_for_text("a model is in service")) << running.terminal_text();
  testing::write_text(
      folder_ / "x.toml",
      mission_config("gap = 3", "out = \"out\"\nplotjuggler = \"" + listener.port() + "\""));
  running.send(SIGHUP);
  ASSERT_TRUE(running.wait_for_text("was read anew")) << running.terminal_text();
  EXPECT_NE(running.terminal_text().find("log.gap has changed"), std::string::npos);
  std::size_t heard = 0;
  EXPECT_TRUE(running.wait_until([&] { return (heard += listener.heard().size()) > 10; }));
  write("x.toml", "[log]\nrate = \"ten\"\n");
  running.send(SIGHUP);
  ASSERT_TRUE(running.wait_for_text("the configuration stays as it was"))
      << running.terminal_text();
  EXPECT_NE(running.terminal_text().find("x.toml:2: log.rate"), std::string::npos);
  running.send(SIGTERM);
  EXPECT_EQ(running.exit_code(), 0);
}

TEST_F(LiveCommand, ItsCheckpointIsWhereLearnAndPredictGoOn) {
  write_mission(120.0, mission_config("", "align = \"none\""));
  ASSERT_EQ(live("--speed max --out out").exit_code, 0);
  EXPECT_EQ(run("learn mission.mcap --config x.toml --split none --from out/checkpoint.kelpie "
                "--out on")
                .exit_code,
            0);
}

}  // namespace
}  // namespace kelpie::live_test
