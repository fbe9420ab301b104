// SPDX-License-Identifier: Apache-2.0
#include "bag/autopilot_state.hpp"

#include <gtest/gtest.h>

#include "bag/ardusub_drive.hpp"
#include "bag/dataflash_reader.hpp"
#include "bag/tlog_reader.hpp"
#include "support.hpp"

namespace kelpie::autopilot_state_test {
namespace {

using bag::AutopilotState;
using bag::ReadMode;

// All messages of a recording; gives how many of them came while motors were disarmed.
std::size_t hear_all(bag::MessageReader& bag, AutopilotState& state) {
  std::size_t disarmed = 0;
  for (bag::Message message; bag.next(message);) {
    state.hear(bag.topics(), message);
    disarmed += state.is_disarmed() ? 1 : 0;
  }
  return disarmed;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

TEST(AutopilotState, BothRecordingsTellParametersAndArmedMotors) {
  testing::Tlog tlog = testing::ArdusubDrive::tlog();
  const std::string bin = testing::ArdusubDrive::bin();
  for (const bool is_bin : {false, true}) {
    const auto bag = is_bin ? bag::read_dataflash(bytes_of(bin), "x.BIN", ReadMode::strict)
                            : bag::read_tlog(tlog.bytes(), "x.tlog", ReadMode::strict);
    AutopilotState state;
    const std::size_t disarmed = hear_all(*bag, state);
    EXPECT_GT(disarmed, 1'000U) << is_bin;
    EXPECT_TRUE(state.was_armed() && state.was_disarmed()) << is_bin;
    EXPECT_EQ(state.is_armed(), std::optional(false)) << is_bin;
    for (const auto& [name, value] : testing::ArdusubDrive::parameters()) {
      EXPECT_EQ(state.parameters().at(name), value) << is_bin << name;
    }
  }
}

// A faulty sender, or a hostile one.
TEST(AutopilotState, AnyNumberOfNamesFillsNoMemory) {
  std::map<std::string, double> parameters;
  for (int k = 0; k < 10'000; ++k) {
    bag::keep_parameter(parameters, "P" + std::to_string(k), k);
  }
  EXPECT_LE(parameters.size(), 4096U);
  bag::keep_parameter(parameters, "P7", -7.0);
  EXPECT_EQ(parameters.at("P7"), -7.0);
}

TEST(AutopilotState, MessagesBeforeTheFirstHeartbeatCountAsDisarmed) {
  mavlink::FrameWriter writer(1, 1);
  testing::Tlog log;
  writer.begin("ATTITUDE").set("roll", 0.5);
  log.add(testing::kTlogBeginUs, writer.finish());
  writer.begin("HEARTBEAT").set("type", 12).set("autopilot", 3).set("base_mode", 209);
  log.add(testing::kTlogBeginUs, writer.finish());
  // Another vehicle's state is none of this one's.
  mavlink::FrameWriter camera(1, 100);
  camera.begin("HEARTBEAT").set("type", 30).set("autopilot", 8).set("base_mode", 0);
  log.add(testing::kTlogBeginUs, camera.finish());
  AutopilotState state;
  const auto bag = bag::read_tlog(log.bytes(), "x.tlog", ReadMode::strict);
  EXPECT_EQ(hear_all(*bag, state), 1U);
  EXPECT_EQ(state.is_armed(), std::optional(true));
  EXPECT_FALSE(state.was_disarmed());
}

}  // namespace
}  // namespace kelpie::autopilot_state_test
