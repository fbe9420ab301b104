// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/rank_executor.hpp"
#include "jobs/rank_group.hpp"

namespace kelpie::testing {

/// What ranks that are threads of this process have in common.
struct RanksShared {
  explicit RanksShared(std::size_t ranks) : texts(ranks) {}

  std::mutex mutex;
  std::condition_variable changed;
  std::array<std::uint64_t, static_cast<std::size_t>(jobs::RankGroup::Counter::count)> counters{};
  std::vector<std::string> texts;
  std::vector<std::string> exchanged;
  std::size_t arrived = 0;
  std::size_t exchanges = 0;
};

class ThreadRanks final : public jobs::RankGroup {
 public:
  ThreadRanks(RanksShared& shared, std::size_t rank) : shared_(shared), rank_(rank) {}
  std::size_t rank() const override { return rank_; }
  std::size_t size() const override { return shared_.texts.size(); }
  std::string host() const override { return "host" + std::to_string(rank_); }

  std::uint64_t fetch_add(Counter counter, std::uint64_t amount) override {
    const std::scoped_lock lock(shared_.mutex);
    return std::exchange(of(counter), of(counter) + amount);
  }
  void reset(Counter counter) override {
    const std::scoped_lock lock(shared_.mutex);
    of(counter) = 0;
  }
  std::vector<std::string> exchange(const std::string& text,
                                    const std::function<void()>& waiting) override {
    std::unique_lock lock(shared_.mutex);
    shared_.texts[rank_] = text;
    const std::size_t mine = shared_.exchanges;
    if (++shared_.arrived == size()) {
      shared_.arrived = 0;
      ++shared_.exchanges;
      shared_.exchanged = shared_.texts;
      shared_.changed.notify_all();
    }
    while (shared_.exchanges == mine) {
      if (shared_.changed.wait_for(lock, std::chrono::milliseconds(1)) == std::cv_status::timeout) {
        lock.unlock();
        waiting();
        lock.lock();
      }
    }
    return shared_.exchanged;
  }
  std::string broadcast(std::string text) override {
    return exchange(text, [] {}).front();
  }

 private:
  std::uint64_t& of(Counter counter) {
    return shared_.counters.at(static_cast<std::size_t>(counter));
  }

  RanksShared& shared_;
  std::size_t rank_;
};

/// Does what every process of a run does, once for each rank. version(rank) is what it is of.
inline void with_ranks(
    std::size_t ranks, const std::function<void(jobs::Executor&, std::size_t rank)>& process,
    const std::function<std::string(std::size_t)>& version = [](std::size_t) { return "1.0"; }) {
  RanksShared shared(ranks);
  {
    std::vector<std::jthread> threads;
    for (std::size_t rank = 0; rank < ranks; ++rank) {
      threads.emplace_back([&, rank] {
        const auto executor = jobs::make_rank_executor(std::make_unique<ThreadRanks>(shared, rank),
                                                       version(rank), std::chrono::milliseconds(0));
        process(*executor, rank);
      });
    }
  }
  EXPECT_EQ(shared.arrived, 0U);
}

}  // namespace kelpie::testing
