// SPDX-License-Identifier: Apache-2.0
#include "mavlink/definition.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string>

#include "file/crc32.hpp"

namespace kelpie::definition_test {
namespace {

// Of `node scripts/mavlink_messages.mjs check`, another implementation's tables.
TEST(Definition, ChecksumsAndLengthsAreThoseOfTheStandard) {
  std::string text;
  for (const mavlink::Definition& definition : mavlink::definitions()) {
    text += std::to_string(definition.id) + " " + definition.name + " " +
            std::to_string(definition.crc_extra) + " " + std::to_string(definition.basic_bytes) +
            " " + std::to_string(definition.all_bytes) + "\n";
  }
  EXPECT_EQ(file::crc32_of(std::as_bytes(std::span(text))), 0x2e9c29f0U) << text;
}

TEST(Definition, IsFoundByNumberAndByName) {
  for (const mavlink::Definition& definition : mavlink::definitions()) {
    EXPECT_EQ(mavlink::find_definition(definition.id), &definition);
    EXPECT_EQ(mavlink::find_definition(definition.name), &definition);
  }
  const mavlink::Definition* const attitude = mavlink::find_definition("ATTITUDE");
  ASSERT_NE(attitude, nullptr);
  EXPECT_EQ(attitude->id, 30U);
  EXPECT_EQ(attitude->find("rollspeed")->unit, "rad/s");
  EXPECT_EQ(attitude->find("rollspeed")->offset, 16U);
  EXPECT_TRUE(mavlink::find_definition("SERVO_OUTPUT_RAW")->find("servo9_raw")->extension);
}

TEST(Definition, WhatIsNotThereIsNull) {
  EXPECT_EQ(mavlink::find_definition("ATTITUDES"), nullptr);
  EXPECT_EQ(mavlink::find_definition(1U << 23U), nullptr);
  EXPECT_EQ(mavlink::find_definition("ATTITUDE")->find("rol"), nullptr);
}

}  // namespace
}  // namespace kelpie::definition_test
