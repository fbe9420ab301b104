// SPDX-License-Identifier: Apache-2.0
#include "lab/soak.hpp"

#include <gtest/gtest.h>

#include <string>

#include "lab/update_times.hpp"

namespace kelpie::soak_test {
namespace {

TEST(Soak, TheSolverKeepsItsPromisesOnAHardStream) {
  lab::SoakPlan plan;
  plan.updates = 4000;
  plan.window = 80;
  plan.check_every = 100;
  const lab::SoakRun run = lab::run_soak(plan);
  EXPECT_EQ(run.updates, plan.updates);
  EXPECT_TRUE(run.good()) << run.gap << " " << run.fallbacks;
  EXPECT_GT(run.gap, 0.0);
  EXPECT_EQ(run.gap, lab::run_soak(plan).gap);
}

TEST(Soak, IsBadWithAGapOrFallbacksBeyondWhatIsAllowed) {
  lab::SoakRun run{.updates = 1'000'000, .fallbacks = 10, .gap = 1e-7};
  EXPECT_TRUE(run.good());
  EXPECT_TRUE(lab::soak_text(run).starts_with("1,000,000 updates, 10 fallbacks"));
  run.fallbacks = 11;
  EXPECT_FALSE(run.good());
  run.fallbacks = 0;
  run.gap = 2e-6;
  EXPECT_FALSE(run.good());
  EXPECT_TRUE(lab::soak_text(run).ends_with("NOT GOOD"));
}

TEST(UpdateTimes, TheHistogramCountsEveryUpdateOnce) {
  lab::UpdateTimes times;
  for (int i = 0; i <= 100; ++i) {
    times.thread_us.push_back(450.0 + i);
    times.wall_us.push_back(30'000.0 + i);
  }
  std::size_t below_half = 0;
  std::size_t thread = 0;
  std::size_t wall = 0;
  for (const lab::TimesBin& bin : lab::histogram_of(times)) {
    below_half += bin.below_us <= 500.0 ? bin.thread : 0;
    thread += bin.thread;
    wall += bin.wall;
  }
  EXPECT_EQ(below_half, 50U);  // of 450 to 550 µs
  EXPECT_EQ(thread, 101U);
  EXPECT_EQ(wall, 101U);
  EXPECT_NE(lab::times_table(times).find("below 500 µs"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::soak_test
