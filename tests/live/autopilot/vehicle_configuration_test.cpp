// SPDX-License-Identifier: Apache-2.0
#include "autopilot/vehicle_configuration.hpp"

#include <gtest/gtest.h>

#include "file/toml.hpp"
#include "kelpie/core/error.hpp"
#include "live/configuration.hpp"

namespace kelpie::vehicle_configuration_test {
namespace {

using autopilot::configuration_text;
using autopilot::HeardVehicle;

// A BlueROV2 Heavy: motor n on output n, motors 3 and 4 reversed.
HeardVehicle heavy() {
  HeardVehicle heard{.messages = {"ATTITUDE", "LOCAL_POSITION_NED", "SERVO_OUTPUT_RAW"}};
  heard.parameters["FRAME_CONFIG"] = 2.0;
  for (int n = 1; n <= 8; ++n) {
    heard.parameters["SERVO" + std::to_string(n) + "_FUNCTION"] = 32.0 + n;
    heard.parameters["MOT_" + std::to_string(n) + "_DIRECTION"] = n == 3 || n == 4 ? -1.0 : 1.0;
  }
  return heard;
}

live::Configuration read(const HeardVehicle& heard) {
  const std::string text = configuration_text("udp:14550", heard);
  return live::read_configuration(file::TomlNode::parse(text, "vehicle"), "vehicle", {});
}

TEST(VehicleConfiguration, HasSixAxesAndEveryMotor) {
  const live::Configuration configuration = read(heavy());
  EXPECT_EQ(configuration.plan.inputs.size(), 16U);
  EXPECT_EQ(configuration.plan.targets.size(), 6U);
  EXPECT_EQ(configuration.plan.inputs.back(), "m8");
  EXPECT_TRUE(configuration.log.mirror_motors);
  EXPECT_TRUE(configuration.log.armed_only);
  EXPECT_TRUE(configuration.live.mavlink.has_value());
}

TEST(VehicleConfiguration, TakesTheGlobalPositionWhereThereIsNoLocalOne) {
  HeardVehicle heard = heavy();
  heard.messages = {"ATTITUDE", "GLOBAL_POSITION_INT", "SERVO_OUTPUT_RAW"};
  const live::Configuration configuration = read(heard);
  const StreamPlan::Source& surge = configuration.plan.sources.front();
  EXPECT_EQ(surge.from, "GLOBAL_POSITION_INT:vx");
  EXPECT_DOUBLE_EQ(surge.scale, 0.01);  // cm/s
}

TEST(VehicleConfiguration, SaysWhatAVehicleDoesNotTell) {
  HeardVehicle no_motor = heavy();
  no_motor.parameters.clear();
  EXPECT_THROW(configuration_text("udp:14550", no_motor), InputError);
  HeardVehicle no_velocity = heavy();
  no_velocity.messages = {"ATTITUDE"};
  EXPECT_THROW(configuration_text("udp:14550", no_velocity), InputError);
}

}  // namespace
}  // namespace kelpie::vehicle_configuration_test
