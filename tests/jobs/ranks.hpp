// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/messenger.hpp"
#include "jobs/rank_executor.hpp"

namespace kelpie::testing {

/// Ranks that are threads of this process.
class Post {
 public:
  explicit Post(std::size_t ranks) : boxes_(ranks) {}
  std::size_t size() const { return boxes_.size(); }

  void put(std::size_t to, jobs::Message message) {
    const std::scoped_lock lock(mutex_);
    boxes_[to].push_back(std::move(message));
  }
  std::optional<jobs::Message> take(std::size_t rank) {
    const std::scoped_lock lock(mutex_);
    std::deque<jobs::Message>& box = boxes_[rank];
    if (box.empty()) {
      return std::nullopt;
    }
    jobs::Message message = std::move(box.front());
    box.pop_front();
    return message;
  }
  /// Whether all that was sent was received.
  bool empty() const {
    bool empty = true;
    for (const auto& box : boxes_) {
      empty = empty && box.empty();
    }
    return empty;
  }

 private:
  std::mutex mutex_;
  std::vector<std::deque<jobs::Message>> boxes_;
};

class PostMessenger final : public jobs::Messenger {
 public:
  PostMessenger(Post& post, std::size_t rank) : post_(post), rank_(rank) {}
  std::size_t rank() const override { return rank_; }
  std::size_t size() const override { return post_.size(); }
  std::string host() const override { return "host" + std::to_string(rank_); }
  void send(std::size_t to, int kind, std::string_view text) override {
    post_.put(to, {rank_, kind, std::string(text)});
  }
  std::optional<jobs::Message> receive() override { return post_.take(rank_); }

 private:
  Post& post_;
  std::size_t rank_;
};

/// Does what every process of a run does, once for each rank. version(rank) is what it is of.
inline void with_ranks(
    std::size_t ranks, const std::function<void(jobs::Executor&, std::size_t rank)>& process,
    const std::function<std::string(std::size_t)>& version = [](std::size_t) { return "1.0"; }) {
  Post post(ranks);
  {
    std::vector<std::jthread> threads;
    for (std::size_t rank = 0; rank < ranks; ++rank) {
      threads.emplace_back([&, rank] {
        const auto executor =
            jobs::make_rank_executor(std::make_unique<PostMessenger>(post, rank), version(rank));
        process(*executor, rank);
      });
    }
  }
  EXPECT_TRUE(post.empty());
}

}  // namespace kelpie::testing
