// SPDX-License-Identifier: Apache-2.0
#include "ros/diagnostics.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace kelpie::diagnosis_test {
namespace {

using ros::DiagnosticStatus;
using Level = live::AlertLevel;

live::Health well() {
  live::Health health;
  health.topics = {{.name = "/odom", .messages = 100}};
  health.sources = {{.name = "u", .from = "/odom:x", .rate_hz = 20.0, .faults = {}}};
  const live::AxisHealth axis{.name = "udot", .status = {.ready = true}};
  health.learner.axes = {axis};
  health.learner.checkpoints = 3;
  return health;
}

DiagnosticStatus part(const live::Health& now, const std::string& name,
                      const live::Health& before = well()) {
  const std::vector<DiagnosticStatus> all = ros::diagnose(now, before);
  return *std::ranges::find(all, name, &DiagnosticStatus::name);
}

TEST(DiagnosticStatus, AllIsWell) {
  for (const DiagnosticStatus& one : ros::diagnose(well(), well())) {
    EXPECT_EQ(one.level, Level::ok) << one.name << ": " << one.message;
    EXPECT_FALSE(one.message.empty());
    EXPECT_FALSE(one.values.empty());
  }
}

TEST(DiagnosticStatus, WhatIsWrongWithMessagesIsNamed) {
  live::Health health = well();
  health.sources[0].silent_s = 5.0;
  health.transport.lost = 2;
  EXPECT_EQ(part(health, "messages").level, Level::warn);
  EXPECT_EQ(part(health, "messages").message, "u is silent; messages are lost");
  EXPECT_EQ(part(health, "messages", health).message, "u is silent");  // no more are lost
  health.topics[0].refused = "no such field";
  EXPECT_EQ(part(health, "messages").level, Level::error);
  health = well();
  health.idle_s = 10.0;
  EXPECT_EQ(part(health, "messages").message, "no messages come, for 10 s");
  health = well();
  health.transport.faults = {"/odom: no publisher any more"};
  EXPECT_EQ(part(health, "messages").message, health.transport.faults[0]);
}

TEST(DiagnosticStatus, ALearnerThatDoesNotLearnIsAWarning) {
  live::Health health = well();
  health.learner.is_paused = true;
  EXPECT_EQ(part(health, "learning").level, Level::warn);
  health = well();
  health.learner.axes[0].status.ready = false;
  EXPECT_EQ(part(health, "learning").message, "no model yet");
  health = well();
  health.rows_dropped = 1;
  EXPECT_EQ(part(health, "learning").level, Level::error);
  health = well();
  health.learner.axes[0].status.tally.changes = 1;
  EXPECT_EQ(part(health, "udot").message, "the vehicle has changed");
}

TEST(DiagnosticStatus, TheCurrentIsShown) {
  live::Health health = well();
  health.reckoning.current_speed = 0.25;
  health.reckoning.current_direction = 126.0;
  const auto values = part(health, "messages").values;
  EXPECT_EQ(
      std::ranges::count(values, std::pair<std::string, std::string>("current/(m/s)", "0.25")), 1);
  EXPECT_EQ(
      std::ranges::count(values, std::pair<std::string, std::string>("current towards/°", "126")),
      1);
}

TEST(DiagnosticStatus, ADiskThatIsFullIsAnError) {
  live::Health health = well();
  health.learner.checkpoint_error = "no space left";
  EXPECT_EQ(part(health, "disk").level, Level::error);
  EXPECT_NE(part(health, "disk").message.find("no space left"), std::string::npos);
  health = well();
  health.record_error = "read-only";
  EXPECT_EQ(part(health, "disk").level, Level::warn);
  EXPECT_EQ(part(health, "disk").message, "nothing can be recorded: read-only");
}

}  // namespace
}  // namespace kelpie::diagnosis_test
