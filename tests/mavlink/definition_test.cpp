// SPDX-License-Identifier: Apache-2.0
#include "mavlink/definition.hpp"

#include <gtest/gtest.h>

#include <array>

namespace kelpie::definition_test {
namespace {

// From another implementation's tables: scripts/mavlink_peer.mjs names it.
TEST(Definition, ChecksumsAndLengthsAreThoseOfTheStandard) {
  struct Known {
    const char* name;
    std::uint32_t id;
    int crc_extra;
    std::size_t basic;
    std::size_t all;
  };
  constexpr std::array<Known, 11> kKnown{{
      {"HEARTBEAT", 0, 50, 9, 9},
      {"SYSTEM_TIME", 2, 137, 12, 12},
      {"ATTITUDE", 30, 39, 28, 28},
      {"LOCAL_POSITION_NED", 32, 185, 28, 28},
      {"SERVO_OUTPUT_RAW", 36, 222, 21, 37},
      {"COMMAND_LONG", 76, 152, 33, 33},
      {"COMMAND_ACK", 77, 143, 3, 10},
      {"NAMED_VALUE_FLOAT", 251, 170, 18, 18},
      {"STATUSTEXT", 253, 83, 51, 54},
      {"ODOMETRY", 331, 91, 230, 233},
      {"ACTUATOR_OUTPUT_STATUS", 375, 251, 140, 140},
  }};
  EXPECT_EQ(mavlink::definitions().size(), kKnown.size());
  for (const Known& known : kKnown) {
    const mavlink::Definition* const definition = mavlink::find_definition(known.name);
    ASSERT_NE(definition, nullptr) << known.name;
    EXPECT_EQ(definition, mavlink::find_definition(known.id));
    EXPECT_EQ(definition->crc_extra, known.crc_extra) << known.name;
    EXPECT_EQ(definition->basic_bytes, known.basic) << known.name;
    EXPECT_EQ(definition->all_bytes, known.all) << known.name;
  }
}

TEST(Definition, WhatIsNotThereIsNull) {
  EXPECT_EQ(mavlink::find_definition("ATTITUDES"), nullptr);
  EXPECT_EQ(mavlink::find_definition(1U << 23U), nullptr);
  EXPECT_EQ(mavlink::find_definition("ATTITUDE")->find("rol"), nullptr);
}

}  // namespace
}  // namespace kelpie::definition_test
