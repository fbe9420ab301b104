// SPDX-License-Identifier: Apache-2.0
// Whom `kelpie live` tells what it does.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "console/live_command.hpp"
#include "live/mission.hpp"
#include "support.hpp"

namespace kelpie::live_outputs_test {
namespace {

using testing::Listener;
using testing::LiveCommand;
using testing::mission_config;
using testing::read_text;

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
  const auto outcome = live("--speed 40 --out out --plotjuggler " + listener.port());
  ASSERT_EQ(outcome.exit_code, 0);
  for (const char* const label : {"R² of late", "inside interval", "outliers", "implausible"}) {
    EXPECT_NE(outcome.out.find(label), std::string::npos) << outcome.out;  // one table for all
  }
  double last = 0.0;
  std::size_t learned = 0;
  std::size_t now = 0;
  std::size_t health = 0;
  for (const nlohmann::json& message : listener.heard()) {
    const nlohmann::json& content = message["kelpie"];
    if (content.contains("learned")) {
      ++learned;
      EXPECT_GT(message["timestamp"], last);
      last = message["timestamp"];
      EXPECT_TRUE(content["learned"]["measured"]["udot"].is_number());
    } else if (content.contains("health")) {
      ++health;
      EXPECT_EQ(content["health"]["messages_lost_total"], 0);
      EXPECT_TRUE(content["axis"]["udot"].contains("axis_r2_model"));
      EXPECT_TRUE(content["signal"]["u"]["signal_silent"].is_number());
    } else if (content.contains("now")) {
      ++now;
      EXPECT_LE(content["now"]["lower"]["udot"], content["now"]["predicted"]["udot"]);
    }
  }
  EXPECT_GT(learned, 500U);
  EXPECT_GT(now, 500U);
  EXPECT_GT(health, 0U);
  EXPECT_NEAR(last, 1'700'000'060.0, 2.0);
}

TEST_F(LiveCommand, AFullDiskIsSaidAndLearningGoesOn) {
  write_mission(120.0, mission_config("clock = \"header\"", "checkpoint = 10\nalign = \"none\""));
  // A file can't grow beyond 16 kB; a checkpoint is larger.
  const std::string command = "cd '" + folder_.path().string() +
                              "' && (ulimit -f 32; " KELPIE_COMMAND
                              " live --config x.toml --from mission.mcap --speed max --out out"
                              " >.stdout 2>.stderr </dev/null)";
  const int status = std::system(command.c_str());  // NOLINT: the test's own
  EXPECT_EQ(WEXITSTATUS(status), 1);
  const std::string said = read_text(folder_ / ".stderr");
  EXPECT_NE(said.find("no checkpoint can be written, learning goes on"), std::string::npos) << said;
  EXPECT_NE(read_text(folder_ / ".stdout").find("samples learned"), std::string::npos);
  expect_model_of_learn("out", "none");  // a model is small
}

}  // namespace
}  // namespace kelpie::live_outputs_test
