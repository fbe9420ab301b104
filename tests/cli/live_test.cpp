// SPDX-License-Identifier: Apache-2.0
// KELPIE_KILLS says how often to kill (default 12):
// KELPIE_KILLS=200 build/release/test_cli --gtest_filter=LiveCommand.*Killed*
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/command.hpp"
#include "cli/running.hpp"
#include "format/checkpoint_file.hpp"
#include "kelpie/core/random.hpp"
#include "live/mission.hpp"
#include "support.hpp"

namespace kelpie::live_test {
namespace {

namespace fs = std::filesystem;
using testing::kelpie;
using testing::little_mission;
using testing::mission_config;
using testing::mission_topics;
using testing::Outcome;
using testing::read_text;
using testing::Running;
using testing::TemporaryFolder;

// PlotJuggler's place: a socket on this machine that takes what is sent to it.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    const int bytes = 1 << 22;
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    socklen_t size = sizeof(address);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~Listener() { ::close(socket_); }
  Listener(const Listener&) = delete;
  Listener(Listener&&) = delete;
  Listener& operator=(const Listener&) = delete;
  Listener& operator=(Listener&&) = delete;

  std::string port() const { return std::to_string(port_); }

  // What has come since the last call.
  std::vector<nlohmann::json> heard() const {
    std::vector<nlohmann::json> messages;
    std::array<char, 65536> bytes{};
    for (;;) {
      const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
      if (count <= 0) {
        return messages;
      }
      messages.push_back(nlohmann::json::parse(bytes.data(), bytes.data() + count));
    }
  }
  // Of these, the times of samples that were learned [s].
  std::vector<double> learned() const {
    std::vector<double> times_s;
    for (const nlohmann::json& message : heard()) {
      if (message["kelpie"].contains("learned")) {
        times_s.push_back(message["timestamp"]);
      }
    }
    return times_s;
  }

 private:
  int socket_;
  int port_ = 0;
};

class LiveCommand : public ::testing::Test {
 protected:
  void write_mission(double seconds, const std::string& config = mission_config()) {
    testing::write_text(folder_ / "mission.mcap",
                        testing::mcap_of(mission_topics(), little_mission(seconds)));
    testing::write_text(folder_ / "x.toml", config);
  }
  Outcome run(const std::string& arguments) { return kelpie(folder_.path(), arguments); }
  Outcome live(const std::string& arguments) {
    return run("live --config x.toml --from mission.mcap " + arguments);
  }
  std::string model_of(const std::string& folder) const {
    return read_text(folder_ / folder / "model.json");
  }
  void expect_model_of_learn(const std::string& folder, const std::string& align = "auto",
                             const std::string& log = "mission.mcap") {
    const Outcome learned =
        run("learn " + log + " --config x.toml --split none --align " + align + " --out of_learn");
    ASSERT_EQ(learned.exit_code, 0) << learned.err;
    EXPECT_FALSE(model_of("of_learn").empty());
    EXPECT_EQ(model_of(folder), model_of("of_learn"));
  }
  void expect_refused(const std::string& arguments, const std::string& message) {
    const Outcome outcome = run("live " + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << "\n" << outcome.err;
  }

  TemporaryFolder folder_;
};

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

TEST_F(LiveCommand, FindsTheShiftOfItsCommandsAsLearnDoes) {
  write_mission(400.0, mission_config("clock = \"header\"\nlag = -0.5"));
  const Outcome outcome = live("--speed max --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("commands are taken"), std::string::npos) << outcome.err;
  expect_model_of_learn("out");
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
  testing::write_text(folder_ / "x.toml", config + "\n[live]\nfrozen = \"learn\"\n");
  const Outcome outcome =
      run("live --config x.toml --from '" + bag.string() + "' --speed max --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_model_of_learn("out", "auto", "'" + bag.string() + "'");
}

TEST_F(LiveCommand, LogsOfAutopilotsEndWithTheModelThatLearnGives) {
  for (const char* const name : {"px4_small.ulg", "ardusub_small.BIN"}) {
    const fs::path log = testing::data_file(fs::path("logs") / name);
    if (log.empty()) {
      GTEST_SKIP() << "no data";
    }
    ASSERT_EQ(run("inspect '" + log.string() + "' --template x.toml").exit_code, 0);
    const Outcome outcome =
        run("live --config x.toml --from '" + log.string() + "' --speed max --fresh --out out");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_model_of_learn("out", "auto", "'" + log.string() + "'");
    fs::remove(folder_ / "x.toml");
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
  testing::write_text(folder_ / "mission.mcap", testing::mcap_of(mission_topics(), messages));
  testing::write_text(folder_ / "x.toml", mission_config("clock = \"header\""));
  const Outcome outcome = live("--speed max --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 times a clock"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("at 5."), std::string::npos) << outcome.err;  // s: a model in service
  const std::size_t count = outcome.out.find(" samples learned");
  ASSERT_NE(count, std::string::npos) << outcome.out;
  const std::size_t line = outcome.out.rfind('\n', count) + 1;
  EXPECT_GT(std::stoi(outcome.out.substr(line)), 1160);
}

TEST_F(LiveCommand, WhatItRecordsIsLearnedToTheSameModel) {
  write_mission(120.0);
  ASSERT_EQ(live("--speed max --out out --record rec").exit_code, 0);
  expect_model_of_learn("out", "auto", "rec/live_0001.mcap");
}

TEST_F(LiveCommand, KilledAnywhereItGoesOnAndLosesNoMoreThanItSays) {
  const char* const wish = std::getenv("KELPIE_KILLS");  // NOLINT: no thread writes it
  const int kills = wish == nullptr ? 12 : std::atoi(wish);
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
  const Outcome outcome = live("--speed max --out out" + std::to_string(rounds));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
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
  const Outcome outcome = live("--speed max --out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("going on from out/checkpoint.kelpie"), std::string::npos);
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
  const Outcome frozen = live("--speed max --out out --freeze");
  ASSERT_EQ(frozen.exit_code, 0) << frozen.err;
  EXPECT_NE(frozen.out.find("rows while learning was frozen, not learned"), std::string::npos)
      << frozen.out;
  EXPECT_EQ(model_of("out"), model);
  const Outcome still = live("--speed max --out out");
  EXPECT_NE(still.err.find("learning is frozen, as it was before"), std::string::npos) << still.err;
  EXPECT_EQ(model_of("out"), model);
  // Another recording is learned.
  testing::write_text(folder_ / "mission.mcap",
                      testing::mcap_of(mission_topics(), little_mission(60.0, 2)));
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
  testing::write_text(folder_ / "x.toml", "[log]\nrate = \"ten\"\n");
  running.send(SIGHUP);
  ASSERT_TRUE(running.wait_for_text("the configuration stays as it was"))
      << running.terminal_text();
  EXPECT_NE(running.terminal_text().find("x.toml:2: log.rate"), std::string::npos);
  running.send(SIGTERM);
  EXPECT_EQ(running.exit_code(), 0);
}

#ifdef KELPIE_HAVE_SYSTEMD
TEST_F(LiveCommand, TellsSystemdHowItDoes) {
  write_mission(60.0);
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (folder_ / "notify").string();
  ASSERT_LT(path.size(), sizeof(address.sun_path));
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  const std::string command = "cd '" + folder_.path().string() + "' && NOTIFY_SOCKET='" + path +
                              "' WATCHDOG_USEC=3000000 " KELPIE_COMMAND
                              " live --config x.toml --from mission.mcap --speed 60 --out out"
                              " >.stdout 2>.stderr </dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0) << read_text(folder_ / ".stderr");  // NOLINT
  std::string said;
  std::array<char, 4096> bytes{};
  for (ssize_t count = 0; (count = ::recv(socket, bytes.data(), bytes.size(), 0)) > 0;) {
    said += std::string(bytes.data(), static_cast<std::size_t>(count)) + "\n";
  }
  ::close(socket);
  EXPECT_TRUE(said.starts_with("READY=1\nWATCHDOG=1\n")) << said;
  EXPECT_TRUE(said.ends_with("STOPPING=1\n")) << said;
}
#endif

TEST_F(LiveCommand, ToldToPlotJugglerIsWhatWasLearned) {
  write_mission(60.0, mission_config("", "align = \"none\""));
  const Listener listener;
  ASSERT_EQ(live("--speed 40 --out out --plotjuggler " + listener.port()).exit_code, 0);
  double last = 0.0;
  std::size_t learned = 0;
  std::size_t now = 0;
  for (const nlohmann::json& message : listener.heard()) {
    const nlohmann::json& content = message["kelpie"];
    if (content.contains("learned")) {
      ++learned;
      EXPECT_GT(message["timestamp"], last);
      last = message["timestamp"];
      EXPECT_TRUE(content["learned"]["measured"]["udot"].is_number());
    } else {
      ++now;
      EXPECT_LE(content["now"]["lower"]["udot"], content["now"]["predicted"]["udot"]);
    }
  }
  EXPECT_GT(learned, 500U);
  EXPECT_GT(now, 500U);
  EXPECT_NEAR(last, 1'700'000'060.0, 2.0);
}

TEST_F(LiveCommand, AFullDiskIsSaidAndLearningGoesOn) {
  write_mission(120.0, mission_config("clock = \"header\"", "checkpoint = 10\nalign = \"none\""));
  // A file can't grow beyond 16 kB; a checkpoint is larger.
  const std::string command = "cd '" + folder_.path().string() +
                              "' && (trap '' XFSZ; ulimit -f 32; " KELPIE_COMMAND
                              " live --config x.toml --from mission.mcap --speed max --out out"
                              " >.stdout 2>.stderr </dev/null)";
  const int status = std::system(command.c_str());  // NOLINT: the test's own
  EXPECT_EQ(WEXITSTATUS(status), 1);
  const std::string said = read_text(folder_ / ".stderr");
  EXPECT_NE(said.find("no checkpoint can be written, learning goes on"), std::string::npos) << said;
  EXPECT_NE(read_text(folder_ / ".stdout").find("samples learned"), std::string::npos);
  expect_model_of_learn("out", "none");  // a model is small
}

TEST_F(LiveCommand, BadInputIsRefusedBeforeAnythingStarts) {
  write_mission(30.0);
  const std::string from = "--config x.toml --from mission.mcap ";
#ifdef KELPIE_WITH_DDS
  testing::write_text(folder_ / "y.toml", mission_config("", "[live.dds]\ndomain = 233"));
  expect_refused("--config y.toml", "y.toml:16: live.dds.domain: is out of range");
#else
  expect_refused("--config x.toml", "--from: is missing");
#endif
  expect_refused("--config no.toml --from mission.mcap", "no.toml");
  expect_refused("--config x.toml --from x.toml", "is no recording of messages");
  expect_refused(from + "--speed fast", "--speed: 'fast' has to be a number > 0, or max");
  expect_refused(from + "--plotjuggler here", "--plotjuggler: 'here' has to be a port");
  expect_refused(from + "--page here", "--page: 'here' has to be a port");
  testing::write_text(folder_ / "y.toml", mission_config("", "checkpoint = 0"));
  expect_refused("--config y.toml --from mission.mcap", "y.toml:15: live.checkpoint: is out of");
  std::string config = mission_config();
  config.replace(config.find("twist.linear.x"), 14, "twist.linear.xx");
  testing::write_text(folder_ / "y.toml", config);
  expect_refused("--config y.toml --from mission.mcap", "did you mean 'twist.linear.x'");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

#ifdef KELPIE_WITH_WEB
TEST_F(LiveCommand, APageThatCantBeIsRefusedBeforeAnythingStarts) {
  write_mission(30.0);
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(socket, 1), 0);
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  const std::string port = std::to_string(ntohs(address.sin_port));
  for (const char* const check : {"", "--check "}) {
    expect_refused(
        "--config x.toml --from mission.mcap --out out " + std::string(check) + "--page " + port,
        "live.page: no page can be at port " + port + " of 127.0.0.1: Address already");
  }
  ::close(socket);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  testing::write_text(folder_ / "y.toml", mission_config("", "page = 0"));
  expect_refused("--config y.toml --from mission.mcap", "y.toml:15: live.page: '0' has to be");
  testing::write_text(folder_ / "y.toml", mission_config("", "token = \"short\""));
  expect_refused("--config y.toml --from mission.mcap", "y.toml:15: live.token: has to be 16 to");
}
#endif

TEST_F(LiveCommand, ACheckpointOfAnotherConfigurationIsRefused) {
  write_mission(60.0);
  ASSERT_EQ(live("--speed max --out out").exit_code, 0);
  testing::write_text(folder_ / "x.toml", mission_config("gap = 2"));
  expect_refused("--config x.toml --from mission.mcap --out out",
                 "out/checkpoint.kelpie: log.gap: is '1' there, '2' in this run");
  testing::write_text(folder_ / "x.toml", mission_config());
  expect_refused("--config x.toml --from mission.mcap --out out --set buffer=70", "buffer");
  EXPECT_EQ(live("--speed max --out out --set buffer=70 --fresh").exit_code, 0);
}

TEST_F(LiveCommand, ACheckLeavesNothingBehind) {
  write_mission(30.0);
  const Outcome outcome = live("--check --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("u: /odom:twist.linear.x"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("begins anew"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
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
