// SPDX-License-Identifier: Apache-2.0
#include "ros/text_message.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "bag/message_builder.hpp"

namespace kelpie::text_message_test {
namespace {

using Bytes = std::vector<std::byte>;

Bytes message_of(const std::string& text) {
  bag::MessageBuilder message(bag::MessageDefinitions().type(ros::kTextType));
  message.set("data", text);
  const std::span<const std::byte> bytes = message.bytes();
  return {bytes.begin(), bytes.end()};
}

TEST(TextMessage, IsReadInBothByteOrders) {
  EXPECT_EQ(ros::text_of(message_of("freeze")), "freeze");
  EXPECT_EQ(ros::text_of(message_of("")), "");
  Bytes big = message_of("save");
  big[1] = std::byte{0};
  std::swap(big[4], big[7]);
  EXPECT_EQ(ros::text_of(big), "save");
}

TEST(TextMessage, BytesThatAreNoneAreRefused) {
  const Bytes whole = message_of("freeze");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(ros::text_of(std::span(whole).first(size))) << size;
  }
  Bytes lying = whole;
  for (std::size_t i = 4; i < 8; ++i) {
    lying[i] = std::byte{0xff};
  }
  EXPECT_FALSE(ros::text_of(lying));
  Bytes foreign = whole;
  foreign[0] = std::byte{7};
  EXPECT_FALSE(ros::text_of(foreign));
}

}  // namespace
}  // namespace kelpie::text_message_test
