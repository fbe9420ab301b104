// SPDX-License-Identifier: Apache-2.0
#include "jobs/executor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <stdexcept>

namespace kelpie::executor_test {
namespace {

std::vector<jobs::Job> some_jobs(std::size_t count) {
  std::vector<jobs::Job> list;
  for (std::size_t i = 0; i < count; ++i) {
    list.push_back({.cost = 1.0 + static_cast<double>(i % 5)});
  }
  return list;
}

TEST(ThreadExecutor, GivesEveryResultOnceWithAnyNumberOfThreads) {
  const std::vector<jobs::Job> list = some_jobs(40);
  for (const std::size_t threads : {0U, 1U, 3U}) {
    std::map<std::size_t, std::string> results;
    double last = 0.0;
    const auto executor = jobs::make_thread_executor(threads);
    EXPECT_TRUE(executor->run({
        .jobs = list,
        .work =
            [](std::size_t i, const jobs::Advance& advance) {
              return advance(0.5) ? std::to_string(i) + "!" : "";
            },
        .done = [&](std::size_t i,
                    std::string result) { EXPECT_TRUE(results.emplace(i, result).second); },
        .keep_going =
            [&](double share) {
              EXPECT_GE(share, last);
              last = share;
              return true;
            },
    }));
    ASSERT_EQ(results.size(), list.size());
    EXPECT_EQ(results[7], "7!");
    EXPECT_NEAR(last, 1.0, 1e-12);
  }
}

TEST(ThreadExecutor, BeginsTheCostlyFirst) {
  const std::vector<jobs::Job> list = some_jobs(12);
  std::vector<double> costs;
  jobs::make_thread_executor(1)->run({.jobs = list,
                                      .work =
                                          [&](std::size_t i, const jobs::Advance&) {
                                            costs.push_back(list[i].cost);
                                            return std::string();
                                          },
                                      .done = [](std::size_t, const std::string&) {}});
  EXPECT_TRUE(std::ranges::is_sorted(costs, std::greater{}));
}

TEST(ThreadExecutor, StoppedItTakesNoFurtherResult) {
  const std::vector<jobs::Job> list = some_jobs(100);
  std::size_t done = 0;
  EXPECT_FALSE(jobs::make_thread_executor(2)->run(
      {.jobs = list,
       .work = [](std::size_t, const jobs::Advance&) { return std::string(); },
       .done = [&](std::size_t, const std::string&) { ++done; },
       .keep_going = [&](double) { return done < 3; }}));
  EXPECT_EQ(done, 3U);
}

TEST(ThreadExecutor, ThrowsWhatAJobThrows) {
  const std::vector<jobs::Job> list = some_jobs(10);
  EXPECT_THROW(jobs::make_thread_executor(2)->run(
                   {.jobs = list,
                    .work = [](std::size_t i, const jobs::Advance&) -> std::string {
                      throw std::runtime_error(std::to_string(i));
                    },
                    .done = [](std::size_t, const std::string&) { FAIL(); }}),
               std::runtime_error);
}

TEST(DealByCost, GivesEachJobToTheFreestPart) {
  std::vector<jobs::Job> list;
  for (const double cost : {3.0, 1.0, 7.0, 3.0, 4.0}) {
    list.push_back({.cost = cost});
  }
  EXPECT_EQ(jobs::deal_by_cost(list, 2), (std::vector<std::size_t>{1, 1, 0, 0, 1}));
  EXPECT_EQ(jobs::deal_by_cost(list, 1), std::vector<std::size_t>(5, 0));
  EXPECT_EQ(jobs::deal_by_cost(list, 9), (std::vector<std::size_t>{2, 4, 0, 3, 1}));
  EXPECT_TRUE(jobs::deal_by_cost({}, 3).empty());
}

TEST(DealByCost, LoadsDifferByNoMoreThanTheLeastJobOfTheCostliestPart) {
  const std::vector<jobs::Job> list = some_jobs(101);
  for (const std::size_t parts : {2U, 3U, 16U}) {
    const std::vector<std::size_t> part_of = jobs::deal_by_cost(list, parts);
    std::vector<double> loads(parts, 0.0);
    for (std::size_t i = 0; i < list.size(); ++i) {
      loads.at(part_of[i]) += list[i].cost;
    }
    EXPECT_LE(std::ranges::max(loads) - std::ranges::min(loads), 1.0) << parts;
  }
}

// Two learners on 640 logs: the estimate of the first is wrong by a factor of up to four either
// way.
TEST(DealByCost, SharesEveryKindEquallyWhereEstimatesOfKindsAreWrong) {
  const std::size_t parts = 16;
  for (const double factor : {0.25, 1.0, 4.0}) {
    std::vector<jobs::Job> list;
    std::vector<double> true_costs;
    for (std::size_t i = 0; i < 1280; ++i) {
      const double size = 1.0 + 0.01 * static_cast<double>(i % 37);
      list.push_back({.cost = size * (i % 2 == 0 ? factor : 1.0), .kind = i % 2});
      true_costs.push_back(size * (i % 2 == 0 ? 2.0 : 1.0));
    }
    const std::vector<std::size_t> part_of = jobs::deal_by_cost(list, parts);
    std::vector<double> loads(parts, 0.0);
    for (std::size_t i = 0; i < list.size(); ++i) {
      loads.at(part_of[i]) += true_costs[i];
    }
    EXPECT_LE(std::ranges::max(loads) - std::ranges::min(loads), 2.0) << factor;
  }
}

}  // namespace
}  // namespace kelpie::executor_test
