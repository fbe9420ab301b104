// SPDX-License-Identifier: Apache-2.0
#include "dds/message_queue.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstring>
#include <thread>

namespace kelpie::message_queue_test {
namespace {

using std::chrono::milliseconds;

void put(dds::MessageQueue& queue, std::int64_t number, std::size_t topic = 1) {
  std::array<std::byte, sizeof number> bytes{};
  std::memcpy(bytes.data(), &number, sizeof number);
  queue.push(topic, number, number, bytes);
}

TEST(MessageQueue, FullItLosesTheOldestAndCountsThem) {
  dds::MessageQueue queue(3);
  for (int k = 0; k < 5; ++k) {
    put(queue, k);
  }
  EXPECT_EQ(queue.size(), 3U);
  EXPECT_EQ(queue.lost(), 2U);
  dds::TopicSample message;
  for (int k = 2; k < 5; ++k) {
    ASSERT_TRUE(queue.pop(message, milliseconds(0)));
    EXPECT_EQ(message.source_ns, k);
    EXPECT_EQ(message.topic, 1U);
    EXPECT_EQ(message.cdr.size(), sizeof(std::int64_t));
  }
  EXPECT_FALSE(queue.pop(message, milliseconds(0)));
}

TEST(MessageQueue, AFloodedTopicTakesNothingFromTheOthersAndTheirOrderStays) {
  dds::MessageQueue queue(3);
  put(queue, 0, 0);
  put(queue, 1, 2);
  for (int k = 2; k < 100; ++k) {
    put(queue, k, 1);
  }
  put(queue, 100, 0);
  EXPECT_EQ(queue.lost(), 95U);
  dds::TopicSample message;
  for (const std::int64_t number : {0, 1, 97, 98, 99, 100}) {
    ASSERT_TRUE(queue.pop(message, milliseconds(0)));
    EXPECT_EQ(message.source_ns, number);
  }
  EXPECT_EQ(queue.size(), 0U);
}

TEST(MessageQueue, LongMessagesAreBoundedInBytes) {
  const std::vector<std::byte> bytes(dds::kTuning.message_bytes);
  const std::size_t room = dds::kTuning.queued_bytes / bytes.size();
  dds::MessageQueue queue;
  put(queue, 0, 2);
  for (int k = 0; k < 100; ++k) {
    queue.push(1, k, k, bytes);
  }
  EXPECT_EQ(queue.size(), room + 1);
  EXPECT_EQ(queue.lost(), 100 - room);
  dds::TopicSample message;
  ASSERT_TRUE(queue.pop(message, milliseconds(0)));
  EXPECT_EQ(message.topic, 2U);
  for (std::size_t k = 100 - room; k < 100; ++k) {
    ASSERT_TRUE(queue.pop(message, milliseconds(0)));
    EXPECT_EQ(message.source_ns, static_cast<std::int64_t>(k));
    EXPECT_EQ(message.cdr.size(), bytes.size());
  }
  EXPECT_FALSE(queue.pop(message, milliseconds(0)));
}

TEST(MessageQueue, AForgottenTopicIsGoneAndTheOthersStay) {
  dds::MessageQueue queue(3);
  put(queue, 0, 1);
  put(queue, 1, 2);
  queue.forget(1);
  queue.forget(7);
  dds::TopicSample message;
  ASSERT_TRUE(queue.pop(message, milliseconds(0)));
  EXPECT_EQ(message.topic, 2U);
  EXPECT_EQ(queue.size(), 0U);
  put(queue, 2, 1);
  EXPECT_EQ(queue.size(), 1U);
}

TEST(MessageQueue, BetweenThreadsNothingIsDoubledAndWhatIsLostIsCounted) {
  constexpr std::int64_t kEach = 20'000;
  dds::MessageQueue queue(64);
  std::atomic<int> writing = 2;
  const auto write = [&] {
    for (std::int64_t k = 0; k < kEach; ++k) {
      put(queue, k);
    }
    --writing;
  };
  std::thread first(write);
  std::thread second(write);
  std::uint64_t taken = 0;
  dds::TopicSample message;
  while (writing > 0 || queue.size() > 0) {
    if (queue.pop(message, milliseconds(1))) {
      std::int64_t number = 0;
      std::memcpy(&number, message.cdr.data(), sizeof number);
      EXPECT_EQ(number, message.source_ns);
      ++taken;
    }
  }
  first.join();
  second.join();
  EXPECT_EQ(taken + queue.lost(), std::uint64_t{2 * kEach});
}

}  // namespace
}  // namespace kelpie::message_queue_test
