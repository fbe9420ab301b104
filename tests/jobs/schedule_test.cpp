// SPDX-License-Identifier: Apache-2.0
#include "jobs/schedule.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace kelpie::schedule_test {
namespace {

using jobs::simulate_schedule;

TEST(Schedule, WithoutMessagesIsThatOfAListOnMachines) {
  // 5 | 4, 2 | 3, 3: the last one goes to whoever is free first
  const std::vector<double> seconds{5, 4, 3, 3, 2};
  EXPECT_DOUBLE_EQ(simulate_schedule(seconds, {.ranks = 3}).makespan_s, 6.0);
  EXPECT_DOUBLE_EQ(simulate_schedule(seconds, {.ranks = 3}).efficiency, 17.0 / 18.0);
  EXPECT_DOUBLE_EQ(simulate_schedule(seconds, {.ranks = 1}).makespan_s, 17.0);
  EXPECT_DOUBLE_EQ(simulate_schedule(seconds, {.ranks = 100}).makespan_s, 5.0);
}

// Two ranks, of which one sends: its jobs take a second of the leader each, then one to arrive.
TEST(Schedule, CountsTheLeadersTimeAndTheWay) {
  const std::vector<double> seconds(4, 2.0);
  const jobs::Schedule schedule = simulate_schedule(
      seconds,
      {.ranks = 2, .message_s = 0.5, .latency_s = 1.0, .bytes_per_job = 50, .bytes_per_s = 100});
  // leader: 0–2, 2–4, 4–6; the other: 0–1 told, 1–2 on the way, 2–4, told until 5 …
  EXPECT_DOUBLE_EQ(schedule.makespan_s, 6.0);
  EXPECT_DOUBLE_EQ(schedule.efficiency, 8.0 / 12.0);
}

// However many ranks there are, no more jobs are begun than the leader can give.
TEST(Schedule, EndsToScaleWhereTheLeaderIsBusy) {
  const std::vector<double> seconds(20'000, 0.1);
  const jobs::Schedule schedule = simulate_schedule(seconds, {.ranks = 1000, .message_s = 0.001});
  EXPECT_GT(schedule.makespan_s, 19.0);
  EXPECT_GT(schedule.leader_busy, 0.95);
  EXPECT_LT(schedule.efficiency, 0.11);
}

}  // namespace
}  // namespace kelpie::schedule_test
