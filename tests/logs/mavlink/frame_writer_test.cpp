// SPDX-License-Identifier: Apache-2.0
#include "mavlink/frame_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

#include "kelpie/core/error.hpp"
#include "mavlink/frames.hpp"

namespace kelpie::frame_writer_test {
namespace {

using testing::Bytes;
using testing::bytes_of_hex;

Bytes bytes_of(std::span<const std::byte> frame) {
  return {frame.begin(), frame.end()};
}

// The frames of scripts/mavlink_peer.mjs, to the last byte.
TEST(FrameWriter, WritesWhatAnotherImplementationWrites) {
  mavlink::FrameWriter third(7, 9);
  for (int k = 0; k < 3; ++k) {
    third.begin("HEARTBEAT").finish();
  }
  mavlink::FrameWriter writer = third;
  writer.begin("ATTITUDE").set("time_boot_ms", 1234).set("roll", 0.5).set("yaw", -2);
  EXPECT_EQ(bytes_of(writer.finish()),
            bytes_of_hex("fd1000000307091e0000d20400000000003f00000000000000c0b73b"));
  writer = third;
  writer.begin("COMMAND_LONG").set("command", 511).set("param1", 36).set("param2", 50'000);
  writer.set("target_system", 1).set("target_component", 1);
  EXPECT_EQ(bytes_of(writer.finish()),
            bytes_of_hex("fd2000000307094c0000000010420050434700000000000000000000000000000000"
                         "00000000ff010101ef48"));
  writer = third;
  writer.begin("STATUSTEXT").set("severity", 4).set("text", "hull touched");
  EXPECT_EQ(bytes_of(writer.finish()),
            bytes_of_hex("fd0d0000030709fd00000468756c6c20746f75636865643a0a"));
}

TEST(FrameWriter, WhatDoesNotFitIsNamed) {
  mavlink::FrameWriter writer(1);
  EXPECT_THROW(writer.begin("ATTITUDES"), InputError);
  writer.begin("STATUSTEXT");
  EXPECT_THROW(writer.set("text", 1.0), InputError);
  EXPECT_THROW(writer.set("severity", "high"), InputError);
  EXPECT_THROW(writer.set("sevrity", 1.0), InputError);
  EXPECT_THROW(writer.set("severity", 1.0, 1), InputError);
  for (const double value : {-1.0, 256.0, 0.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(writer.set("severity", value), InputError) << value;
  }
  writer.begin("ODOMETRY");
  EXPECT_THROW(writer.set("quality", -129.0), InputError);
  EXPECT_THROW(writer.set("time_usec", 18446744073709551616.0), InputError);
  EXPECT_THROW(writer.set("q", 1.0, 4), InputError);
}

TEST(FrameWriter, ALongTextIsCutOffAndAFullOneHasNoEnd) {
  mavlink::FrameWriter writer(1);
  const std::string text(60, 'x');
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  parser.add(writer.begin("NAMED_VALUE_FLOAT").set("name", text).set("value", 2.5).finish());
  ASSERT_TRUE(parser.next(frame));
  EXPECT_EQ(testing::text_of(frame, "name"), text.substr(0, 10));
  EXPECT_EQ(testing::number_of(frame, "value"), 2.5);
}

RC_GTEST_PROP(FrameWriter, WhateverIsWrittenIsReadBack,
              (const std::vector<std::vector<float>>& messages)) {
  mavlink::FrameWriter writer(3);
  mavlink::FrameParser parser;
  mavlink::Frame frame;
  const mavlink::Definition& definition = *mavlink::find_definition("ACTUATOR_OUTPUT_STATUS");
  for (const std::vector<float>& values : messages) {
    writer.begin(definition.name).set("time_usec", static_cast<double>(values.size()));
    const std::size_t count = std::min<std::size_t>(32, values.size());
    for (std::size_t i = 0; i < count; ++i) {
      writer.set("actuator", static_cast<double>(values[i]), i);
    }
    parser.add(writer.finish());
    RC_ASSERT(parser.next(frame));
    RC_ASSERT(testing::number_of(frame, "time_usec") == static_cast<double>(values.size()));
    for (std::size_t i = 0; i < count; ++i) {
      RC_ASSERT(testing::number_of(frame, "actuator", i) == static_cast<double>(values[i]));
    }
  }
  RC_ASSERT(parser.counts().lost == 0U);
}

}  // namespace
}  // namespace kelpie::frame_writer_test
