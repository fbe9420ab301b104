// SPDX-License-Identifier: Apache-2.0
// Poses in place of velocities: learned half a window late, as in a log.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "console/live_command.hpp"
#include "live/pose_mission.hpp"

namespace kelpie::live_poses_test {
namespace {

using testing::LiveCommand;
using testing::Outcome;
using testing::pose_config;
using testing::PoseLog;
using testing::succeeded;

constexpr std::int64_t kBegin = 1'700'000'000 * testing::kSecond;

TEST_F(LiveCommand, PosesEndWithTheModelOfLearn) {
  write("mission.mcap", testing::mcap_of(testing::pose_topics(),
                                         testing::pose_mission(PoseLog(240.0), kBegin, 0.01)));
  write("x.toml", pose_config());
  const Outcome outcome = succeeded(live("--speed max --out out"));
  EXPECT_NE(outcome.err.find("a model is in service"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("no pose is measured"), std::string::npos) << outcome.err;
  expect_model_of_learn("out");
  const Outcome checked = succeeded(live("--check --out other"));
  EXPECT_NE(checked.out.find("rows come 1.5 s late"), std::string::npos) << checked.out;
  write("x.toml", pose_config("window = 4"));
  expect_refused("--config x.toml --from mission.mcap --out out", "log.pose: is 'x, y, z");
}

TEST_F(LiveCommand, ATableOfPosesEndsWithTheModelOfLearn) {
  write("log.csv", PoseLog(240.0).csv(0.01));
  const std::string columns = " --pose x,y,psi --inputs u,v,r,n,m --rate 5";
  succeeded(run("live --replay log.csv --speed max --out out" + columns));
  succeeded(run("learn log.csv --split none --out of_learn" + columns));
  // Times count from the first row, and so differ by rounding.
  const nlohmann::json live = parsed("out/model.json");
  const nlohmann::json learned = parsed("of_learn/model.json");
  ASSERT_EQ(live["axes"].size(), 3U);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const nlohmann::json& weights = live["axes"][axis]["steady"]["weights"];
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double other = learned["axes"][axis]["steady"]["weights"][k].get<double>();
      EXPECT_NEAR(weights[k].get<double>(), other, 1e-9 + 1e-6 * std::abs(other));
    }
  }
}

TEST_F(LiveCommand, WhatPosesCannotGiveIsRefused) {
  write("mission.mcap", testing::mcap_of(testing::pose_topics(),
                                         testing::pose_mission(PoseLog(10.0), kBegin, 0.01)));
  write("y.toml", pose_config("window = \"auto\""));
  expect_refused("--config y.toml --replay mission.mcap",
                 "log.window: of a pose takes a whole log");
  write("y.toml",
        "[log]\nrate = 5\nwindow = 3\npose = {x = \"LOCAL_POSITION_NED:x\", y = "
        "\"LOCAL_POSITION_NED:y\", yaw = \"ATTITUDE:yaw\"}\n[log.commands]\nn = "
        "\"SERVO_OUTPUT_RAW:servo1_raw\"\n[live.mavlink]\nconnection = \"udp:0\"\n"
        "velocity = \"ODOMETRY\"\n");
  expect_refused("--config y.toml --check",
                 "y.toml:9: live.mavlink.velocity: tells measured velocities to the autopilot");
}

}  // namespace
}  // namespace kelpie::live_poses_test
