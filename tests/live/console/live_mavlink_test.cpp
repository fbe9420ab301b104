// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "autopilot/byte_line.hpp"
#include "autopilot/rov.hpp"
#include "cli/command.hpp"
#include "cli/running.hpp"
#include "web/client.hpp"

namespace kelpie::live_mavlink_test {
namespace {

using autopilot::Connection;
using testing::kelpie;
using testing::Outcome;
using testing::Rov;
using testing::rov_config;
using testing::Running;

// A port of this machine that nobody has.
std::string free_port() {
  return std::to_string(autopilot::UdpLine({.port = 0}).port());
}

// A vehicle at the other end of kelpie's port, four times as quick as a real one.
class Vehicle {
 public:
  explicit Vehicle(const std::string& port)
      : line_({.kind = Connection::Kind::udp_send,
               .host = "127.0.0.1",
               .port = static_cast<std::uint16_t>(std::stoi(port))}) {}

  void go() {
    const auto send = [&](std::span<const std::byte> bytes) { line_.write(bytes); };
    rov.go(0.1, send);
    for (auto bytes = line_.read(std::chrono::milliseconds(10)); !bytes.empty();
         bytes = line_.read(std::chrono::milliseconds(0))) {
      rov.hear(bytes, send);
    }
  }

  Rov rov;

 private:
  autopilot::UdpLine line_;
};

using LiveMavlink = testing::CommandTest;

TEST_F(LiveMavlink, LearnsFromAVehicleAndTellsItWhatItPredicts) {
  const std::string port = free_port();
  write("x.toml", rov_config("connection = \"udp:" + port + "\"", "record = \"rec\""));
  Running live(folder_.path(), {"live", "--config", "x.toml", "--out", "out"});
  Vehicle vehicle(port);
  EXPECT_TRUE(live.wait_until([&] {
    vehicle.go();
    return vehicle.rov.t_s() > 60.0 && vehicle.rov.heard["udot"] > 5;
  })) << live.terminal_text();
  EXPECT_DOUBLE_EQ(vehicle.rov.rates_hz["SERVO_OUTPUT_RAW"], 20.0);
  EXPECT_GE(vehicle.rov.heard["HEARTBEAT"], 2);
  EXPECT_TRUE(vehicle.rov.values.contains("udot"));
  live.press_ctrl_c();
  EXPECT_EQ(live.exit_code(), 0);
  EXPECT_TRUE(exists("out/model.json"));
  // What came was recorded, and is learned as a log.
  const Outcome learned = run("learn rec/live_0001.mcap --config x.toml --split none --out b");
  EXPECT_EQ(learned.exit_code, 0) << learned.err;
}

// Motors 1 and 2 on outputs 3 and 1, motor 2 reversed, lights on output 4: no file says so.
TEST_F(LiveMavlink, AVehicleTellsWhatItsMessagesMean) {
  const std::string port = free_port();
  Running live(folder_.path(), {"live", "--mavlink", "udp:" + port, "--set", "buffer=60", "--set",
                                "anchors=20", "--out", "out"});
  Vehicle vehicle(port);
  vehicle.rov.is_armed = true;
  vehicle.rov.parameters = {
      {"FRAME_CONFIG", 1.0}, {"MOT_1_DIRECTION", 1.0}, {"MOT_2_DIRECTION", -1.0}};
  for (int output = 1; output <= 16; ++output) {
    vehicle.rov.parameters["SERVO" + std::to_string(output) + "_FUNCTION"] = output == 1   ? 34.0
                                                                             : output == 3 ? 33.0
                                                                             : output == 4 ? 181.0
                                                                                           : 0.0;
  }
  EXPECT_TRUE(live.wait_until([&] {
    vehicle.go();
    return vehicle.rov.t_s() > 60.0 && vehicle.rov.heard["udot"] > 5;
  })) << live.terminal_text();
  EXPECT_TRUE(live.wait_for_text("outputs 4 (lights 1)"));
  live.press_ctrl_c();
  EXPECT_EQ(live.exit_code(), 0);
  EXPECT_TRUE(exists("out/model.json"));
  const std::string told = content("out/vehicle.toml");
  EXPECT_NE(told.find("m1 = \"SERVO_OUTPUT_RAW:servo3_raw\""), std::string::npos) << told;
  EXPECT_NE(told.find("m2 = \"SERVO_OUTPUT_RAW:servo1_raw\""), std::string::npos) << told;
  EXPECT_NE(told.find("vectored, 6 motors"), std::string::npos) << told;
  // The file is a configuration like any other.
  const Outcome checked = run("live --config out/vehicle.toml --out again --check");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_NE(checked.out.find("m2: SERVO_OUTPUT_RAW:servo1_raw"), std::string::npos) << checked.out;
}

TEST_F(LiveMavlink, ACheckAsksTheVehicleAndWritesNothing) {
  const std::string port = free_port();
  Running live(folder_.path(), {"live", "--mavlink", "udp:" + port, "--check", "--out", "out"});
  Vehicle vehicle(port);
  vehicle.rov.is_armed = true;
  vehicle.rov.parameters = {
      {"FRAME_CONFIG", 1.0}, {"MOT_1_DIRECTION", 1.0}, {"MOT_2_DIRECTION", 1.0}};
  for (int output = 1; output <= 16; ++output) {
    vehicle.rov.parameters["SERVO" + std::to_string(output) + "_FUNCTION"] =
        output < 3 ? 32.0 + output : 0.0;
  }
  live.wait_until([&] {
    vehicle.go();
    return false;
  });
  EXPECT_EQ(live.exit_code(), 0) << live.terminal_text();
  EXPECT_FALSE(exists("out/vehicle.toml"));
}

TEST_F(LiveMavlink, AConnectionWithoutAVehicleIsTold) {
  const Outcome odd = run("live --mavlink nowhere --out out");
  EXPECT_EQ(odd.exit_code, 2);
  EXPECT_NE(odd.err.find("--mavlink"), std::string::npos) << odd.err;
  EXPECT_EQ(run("live --mavlink udp:14550 --demo").exit_code, 2);
}

// Autopilots by the thousand before the vehicle comes, and forged samples under its numbers.
TEST_F(LiveMavlink, NeitherLosesTheVehicleNorLearnsFromAnother) {
  const std::string port = free_port();
  write("x.toml", rov_config("connection = \"udp:" + port + "\""));
  Running live(folder_.path(), {"live", "--config", "x.toml", "--out", "out"});
  EXPECT_TRUE(live.wait_for_text("no HEARTBEAT of an autopilot"));
  autopilot::UdpLine others(
      {.kind = Connection::Kind::udp_send, .port = static_cast<std::uint16_t>(std::stoi(port))});
  for (int sender = 0; sender < 10'000; ++sender) {
    mavlink::FrameWriter writer(static_cast<std::uint8_t>(2 + sender / 40),
                                static_cast<std::uint8_t>(1 + sender % 40));
    others.write(testing::heartbeat_of_vehicle(writer));
    if (sender % 100 == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // no more than a port takes
    }
  }
  Vehicle vehicle(port);
  mavlink::FrameWriter forger(1, 1);
  double most = 0.0;
  EXPECT_TRUE(live.wait_until([&] {
    vehicle.go();
    if (vehicle.rov.t_s() > 2.0) {
      others.write(testing::heartbeat_of_vehicle(forger));
      forger.begin("ODOMETRY").set("time_usec", std::round(1e6 * vehicle.rov.t_s()));
      others.write(forger.set("vx", 1e6).set("q", 1.0).finish());
    }
    most = std::max(most, std::abs(vehicle.rov.values["udot"]));
    return vehicle.rov.t_s() > 60.0 && vehicle.rov.heard["udot"] > 5;
  })) << live.terminal_text();
  EXPECT_LT(most, 10.0);
  EXPECT_TRUE(live.wait_for_text("two senders are system 1, component 1"));
  live.press_ctrl_c();
  EXPECT_EQ(live.exit_code(), 0);
  EXPECT_TRUE(exists("out/model.json"));
}

#ifdef KELPIE_WITH_WEB

TEST_F(LiveMavlink, ThePageMakesNoMoreOfARequestThanItIs) {
  const std::string port = free_port();
  const std::string page = free_port();
  write("x.toml", rov_config("connection = \"udp:" + port + "\"", "page = " + page));
  Running live(folder_.path(), {"live", "--config", "x.toml", "--out", "out"});
  EXPECT_TRUE(live.wait_for_text("page: http"));
  const testing::Client client(static_cast<std::uint16_t>(std::stoi(page)));
  const std::size_t bytes = client.get("/").body.size();
  std::string ranges = "bytes=0-";
  for (int k = 0; k < 1'500; ++k) {
    ranges += ",0-";
  }
  const testing::Answered whole = client.get("/", {{"Range", ranges}});
  EXPECT_EQ(whole.status, 200);
  EXPECT_EQ(whole.body.size(), bytes);
  EXPECT_EQ(client.post("/save", {{"Content-Encoding", "br"}}, "\xcf\xff\xff\x7f").status, 415);
  live.press_ctrl_c();
  EXPECT_EQ(live.exit_code(), 0);
}

#endif

TEST_F(LiveMavlink, CheckSaysWhatIsThere) {
  const std::string port = free_port();
  write("x.toml", rov_config("connection = \"udp:" + port + "\""));
  std::atomic<bool> ended{false};
  std::thread vehicle([&] {
    for (Vehicle other(port); !ended;) {
      other.go();
    }
  });
  const Outcome there = run("live --check --config x.toml --out out");
  ended = true;
  vehicle.join();
  EXPECT_EQ(there.exit_code, 0) << there.err;
  EXPECT_NE(there.out.find("MAVLink over udp:" + port), std::string::npos) << there.out;
  EXPECT_NE(there.out.find("the vehicle is system 1, component 1"), std::string::npos) << there.out;
}

TEST_F(LiveMavlink, WhatCannotBeOpenedIsNamedWithFileLineAndKey) {
  const autopilot::UdpLine taken({.port = 0});
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"udp:" + std::to_string(taken.port()), "Address already in use"},
      {"serial:/dev/ttyNONE:115200", "/dev/ttyNONE: No such file or directory"},
      {"serial:/dev/ttyNONE:115201", "has a baud rate that serial lines don't have"}};
  for (const auto& [connection, why] : wrong) {
    write("x.toml", rov_config("connection = \"" + connection + "\""));
    const Outcome refused = run("live --config x.toml --out out");
    testing::expect_refused(refused, "x.toml:19: live.mavlink.connection: ");
    EXPECT_NE(refused.err.find(why), std::string::npos) << refused.err;
  }
}

// A ground station's log: what is in it, learned from, replayed and copied.
TEST_F(LiveMavlink, ATlogIsALogAsAnyOther) {
  testing::Tlog log;
  Rov rov;
  rov.rates_hz = {{"ODOMETRY", 20.0}, {"SERVO_OUTPUT_RAW", 20.0}};
  rov.go(60.0, [&](auto bytes) {
    log.add(testing::kTlogBeginUs + static_cast<std::uint64_t>(1e6 * rov.t_s()), bytes);
  });
  write("a.tlog", log.text());
  write("x.toml", rov_config(""));
  const Outcome inspected = run("inspect a.tlog");
  EXPECT_EQ(inspected.exit_code, 0) << inspected.err;
  EXPECT_NE(inspected.out.find("servo1_raw"), std::string::npos);
  EXPECT_NE(inspected.out.find("m/s"), std::string::npos);
  const auto model = [&](const std::string& command, const std::string& out) {
    const Outcome done = run(command + " --config x.toml --out " + out);
    EXPECT_EQ(done.exit_code, 0) << command << ": " << done.err;
    return testing::content_of(folder_ / out / "model.json");
  };
  const std::string learned = model("learn a.tlog --split none --align none", "learn");
  EXPECT_EQ(model("live --from a.tlog --speed max", "live"), learned);
  EXPECT_EQ(run("convert a.tlog --out b.mcap").exit_code, 0);
  EXPECT_EQ(model("learn b.mcap --split none --align none", "mcap"), learned);
  const Outcome columns = run("convert a.tlog --columns ODOMETRY:vx,ODOMETRY:q[0] --out c.csv");
  EXPECT_EQ(columns.exit_code, 0) << columns.err;
  EXPECT_TRUE(content("c.csv").starts_with("t,ODOMETRY:vx,ODOMETRY:q[0]\n"));
}

}  // namespace
}  // namespace kelpie::live_mavlink_test
