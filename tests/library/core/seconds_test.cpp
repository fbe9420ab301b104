// SPDX-License-Identifier: Apache-2.0
#include "core/seconds.hpp"

#include <gtest/gtest.h>

namespace kelpie::seconds_test {
namespace {

TEST(Seconds, AreTheNearestThereAre) {
  EXPECT_EQ(seconds(1), 1e-9);
  EXPECT_EQ(seconds(-250'000'000), -0.25);
  EXPECT_EQ(seconds(86'400'100'000'000), 86'400.1);
  EXPECT_EQ(seconds(1'700'000'000'250'000'000), 1'700'000'000.25);  // no double of ns
  EXPECT_EQ(seconds(-1'700'000'000'250'000'000), -1'700'000'000.25);
  EXPECT_EQ(seconds(1'700'000'000'100'000'000), 1'700'000'000.1);
}

TEST(Seconds, ReturnToTheNanosecondWithinAMonth) {
  for (const std::int64_t time_ns : {0L, 1L, -7L, 999'999'999L, 2'591'999'123'456'789L}) {
    EXPECT_EQ(nanoseconds(seconds(time_ns)), time_ns);
  }
}

}  // namespace
}  // namespace kelpie::seconds_test
