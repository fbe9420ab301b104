// SPDX-License-Identifier: Apache-2.0
#include "jobs/run_all.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace kelpie::run_all_test {
namespace {

TEST(RunAll, DoesEveryJobOnceWithAnyNumberOfThreads) {
  for (const std::size_t threads : {0U, 1U, 2U, 7U}) {
    std::vector<std::atomic<int>> done(50);
    jobs::run_all(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    for (const std::atomic<int>& count : done) {
      EXPECT_EQ(count, 1) << threads;
    }
  }
  jobs::run_all(0, 2, [](std::size_t) { FAIL(); });
}

TEST(RunAll, ThrowsWhatAJobThrowsAndBeginsNoFurther) {
  std::atomic<std::size_t> begun = 0;
  const auto job = [&](std::size_t i) {
    ++begun;
    if (i == 3) {
      throw std::runtime_error("no");
    }
  };
  EXPECT_THROW(jobs::run_all(1000, 1, job), std::runtime_error);
  EXPECT_EQ(begun, 4U);
  EXPECT_THROW(jobs::run_all(1000, 4, job), std::runtime_error);
}

TEST(RunAll, EndsWhenAskedAndTellsTheShare) {
  std::size_t done = 0;
  double last = 0.0;
  const auto job = [&](std::size_t) { ++done; };
  EXPECT_TRUE(jobs::run_while([&](double share) { return (last = share) <= 1.0; }, 8, 1, job));
  EXPECT_EQ(done, 8U);
  EXPECT_EQ(last, 1.0);
  EXPECT_FALSE(jobs::run_while([](double share) { return share < 0.3; }, 10, 1, job));
  EXPECT_EQ(done, 11U);
}

}  // namespace
}  // namespace kelpie::run_all_test
