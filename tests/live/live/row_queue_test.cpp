// SPDX-License-Identifier: Apache-2.0
#include "live/row_queue.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace kelpie::row_queue_test {
namespace {

live::Row row_at(double t) {
  live::Row row;
  row.t = t;
  row.x = {t};
  row.y = {-t};
  return row;
}

TEST(RowQueue, WhereNobodyWaitsWhatFindsItFullIsLostAndCounted) {
  live::RowQueue queue(3, row_at(0.0));
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(queue.push(row_at(i), false), i < 3);
  }
  EXPECT_EQ(queue.dropped(), 2U);
  queue.close();
  live::Row row;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(queue.pop(row));
    EXPECT_EQ(row.t, i);
    EXPECT_EQ(row.y.front(), -i);
  }
  EXPECT_FALSE(queue.pop(row));
}

TEST(RowQueue, WhoWaitsLosesNothing) {
  live::RowQueue queue(3, row_at(0.0));
  constexpr int kRows = 10'000;
  std::thread learner([&] {
    live::Row row;
    for (int i = 0; i < kRows; ++i) {
      ASSERT_TRUE(queue.pop(row));
      ASSERT_EQ(row.t, i);
    }
  });
  for (int i = 0; i < kRows; ++i) {
    EXPECT_TRUE(queue.push(row_at(i), true));
  }
  learner.join();
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(RowQueue, ClosingLetsGoOfWhoWaits) {
  live::RowQueue queue(1, row_at(0.0));
  ASSERT_TRUE(queue.push(row_at(1.0), true));
  std::thread receiver([&] { EXPECT_FALSE(queue.push(row_at(2.0), true)); });
  queue.close();
  receiver.join();
}

TEST(RowQueue, AfterTheFarewellRowsAreDroppedAndRequestsAreNot) {
  live::RowQueue queue(5, row_at(0.0));
  for (int i = 0; i < 4; ++i) {
    live::Row row = row_at(i);
    row.request = i == 2 ? std::optional(live::Request::freeze) : std::nullopt;
    EXPECT_TRUE(queue.push(row, false));
  }
  EXPECT_TRUE(queue.has_request());
  queue.close(live::RowQueue::Clock::now());
  live::Row row;
  ASSERT_TRUE(queue.pop(row));
  EXPECT_EQ(row.request, live::Request::freeze);
  EXPECT_FALSE(queue.has_request());
  EXPECT_FALSE(queue.pop(row));
  EXPECT_EQ(queue.dropped(), 3U);
}

}  // namespace
}  // namespace kelpie::row_queue_test
