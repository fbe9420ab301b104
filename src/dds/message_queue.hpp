// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

namespace kelpie::dds {

/// A message as it came.
struct TopicSample {
  std::size_t topic = 0;         ///< the number its Subscription was given
  std::int64_t source_ns = 0;    ///< when it was published, by the publisher's clock, since 1970
  std::int64_t receive_ns = 0;   ///< when it came, by this machine's clock, since 1970
  std::vector<std::byte> cdr{};  ///< with the four bytes of its encapsulation, as in bags
};

/// A bounded queue between those who receive and one who takes, with room for `capacity` messages
/// of every topic. A topic that is full loses its oldest message, so that whoever falls behind goes
/// on with what is new, and a topic that is flooded takes nothing from the others. Safe to share
/// between threads. Messages and their bytes are kept and used again: once all have had their
/// longest message, nothing allocates.
class MessageQueue {
 public:
  explicit MessageQueue(std::size_t capacity = 1000);  ///< Requires at least 1.

  /// Appends a copy; never waits for the taker.
  void push(std::size_t topic, std::int64_t source_ns, std::int64_t receive_ns,
            std::span<const std::byte> cdr);

  /// Exchanges `message` for the one that has waited longest. Waits `at_most` for it; false where
  /// none came. Cost: linear in the number of topics.
  bool pop(TopicSample& message, std::chrono::milliseconds at_most);

  std::size_t size() const;    ///< Messages waiting.
  std::uint64_t lost() const;  ///< Messages that were overwritten before they were taken.

 private:
  struct Waiting {
    TopicSample message{};
    std::uint64_t number = 0;  // in the order in which they came
  };
  // Those of one topic, the oldest one at `first`.
  struct Ring {
    std::vector<Waiting> slots{};
    std::size_t first = 0;
    std::size_t size = 0;
  };
  Ring& ring_of(std::size_t topic);

  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::map<std::size_t, Ring> rings_;  // by topic
  std::size_t size_ = 0;
  std::uint64_t came_so_far_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace kelpie::dds
