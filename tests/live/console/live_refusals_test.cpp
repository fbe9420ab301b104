// SPDX-License-Identifier: Apache-2.0
// What `kelpie live` refuses, before anything starts.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "cli/damaged_checkpoint.hpp"
#include "console/live_command.hpp"
#include "live/mission.hpp"

namespace kelpie::live_refusals_test {
namespace {

namespace fs = std::filesystem;
using testing::LiveCommand;
using testing::mission_config;
using testing::Outcome;

TEST_F(LiveCommand, BadInputIsRefusedBeforeAnythingStarts) {
  write_mission(30.0);
  const std::string from = "--config x.toml --from mission.mcap ";
#ifdef KELPIE_WITH_DDS
  write("y.toml", mission_config("", "[live.dds]\ndomain = 233"));
  expect_refused("--config y.toml", "y.toml:16: live.dds.domain: is out of range");
#else
  expect_refused("--config x.toml", "--replay: is missing");
#endif
  expect_refused("", "--config: is missing");
  expect_refused("--replay mission.mcap", "mission.mcap: the signals to use are unclear");
  expect_refused("--config x.toml --replay mission.mcap --from mission.mcap", "--replay excludes");
  expect_refused("--config no.toml --from mission.mcap", "no.toml");
  expect_refused("--config /dev/zero --from mission.mcap", "/dev/zero: is a device; ");
  expect_refused("--replay /dev/zero", "/dev/zero: is a device; ");
  expect_refused("--config x.toml --from x.toml", "x.toml:3: 1 cells in this row");  // no table
  for (const std::string speed : {"fast", "-1", "0", "-0.0", "nan", "inf", "1e18", "1e-300"}) {
    expect_refused(from + "--speed " + speed,
                   "--speed: '" + speed + "' has to be a number from 0.001 to 1e+06, or max");
  }
  for (const std::string port : {"here", "-1", "0", "nan", "inf", "1e18", "65536", "80.5", ":80"}) {
    expect_refused(from + "--plotjuggler " + port,
                   "--plotjuggler: '" + port + "' has to be a port");
    expect_refused(from + "--page " + port, "--page: '" + port + "' has to be a port");
  }
  write("y.toml", mission_config("", "checkpoint = 0"));
  expect_refused("--config y.toml --from mission.mcap", "y.toml:15: live.checkpoint: is out of");
  std::string config = mission_config();
  config.replace(config.find("twist.linear.x"), 14, "twist.linear.xx");
  write("y.toml", config);
  expect_refused("--config y.toml --from mission.mcap", "did you mean 'twist.linear.x'");
  EXPECT_FALSE(exists("out"));
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
        "live.page: cannot listen on 127.0.0.1:" + port + ": Address already");
  }
  ::close(socket);
  EXPECT_FALSE(exists("out"));
  write("y.toml", mission_config("", "page = 0"));
  expect_refused("--config y.toml --from mission.mcap", "y.toml:15: live.page: '0' has to be");
  write("y.toml", mission_config("", "token = \"short\""));
  expect_refused("--config y.toml --from mission.mcap", "y.toml:15: live.token: has to be 16 to");
}
#endif

TEST_F(LiveCommand, ACheckpointOfAnotherConfigurationIsRefused) {
  write_mission(60.0);
  ASSERT_EQ(live("--speed max --out out").exit_code, 0);
  write("x.toml", mission_config("gap = 2"));
  expect_refused(
      "--config x.toml --from mission.mcap --out out",
      "out/checkpoint.kelpie: log.gap: is '1' there, '2' in this run; a run goes on only "
      "as it began; --fresh begins anew, or give another --out");
  write("x.toml", mission_config());
  expect_refused("--config x.toml --from mission.mcap --out out --set buffer=70", "buffer");
  EXPECT_EQ(live("--speed max --out out --set buffer=70 --fresh").exit_code, 0);
}

TEST_F(LiveCommand, ADamagedStateIsRefusedByTheNameOfItsFile) {
  write_mission(60.0, mission_config("", "align = \"none\""));
  testing::succeeded(live("--speed max --out out"));
  testing::expect_refused_by_name(folder_.path(), "out/checkpoint.kelpie",
                                  [&] { return live("--speed max --out out"); });
}

TEST_F(LiveCommand, ACheckLeavesNothingBehind) {
  write_mission(30.0);
  const Outcome outcome = live("--check --out out");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("u: /odom:twist.linear.x"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("begins anew"), std::string::npos);
  EXPECT_FALSE(exists("out"));
}

TEST_F(LiveCommand, TheStartOfARunIsNotOverwritten) {
  write_mission(60.0);
  ASSERT_EQ(live("--speed max --out out").exit_code, 0);
  const std::string model = model_of("out");
  expect_refused(
      "--config x.toml --from mission.mcap --speed max --fresh --out out --nominal out/model.json",
      "would overwrite an input");
  EXPECT_EQ(model_of("out"), model);
}

TEST_F(LiveCommand, ColumnsAreThoseOfATable) {
  write_mission(30.0);
  expect_refused("--demo --inputs nonsense --duration 20 --speed max", "--inputs, --targets");
  expect_refused("--config x.toml --pose x,y,psi --check", "--pose: say what the columns");
  expect_refused("--mavlink udp:14550 --rate 4", "say what the columns");
}

}  // namespace
}  // namespace kelpie::live_refusals_test
