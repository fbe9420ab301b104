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

#include "dds/tuning.hpp"

namespace kelpie::dds {

/// A received message.
struct TopicSample {
  std::size_t topic = 0;         ///< tag of its Subscription
  std::int64_t source_ns = 0;    ///< of publication, by the publisher's clock, since 1970
  std::int64_t receive_ns = 0;   ///< of reception, by this machine's clock, since 1970
  std::vector<std::byte> cdr{};  ///< with the four bytes of encapsulation, as in bags
};

/// Bounded queue between subscriptions and a reader, with room for `capacity` messages and
/// Tuning::queued_bytes of each topic. A full topic loses its oldest messages; a flooded topic
/// displaces no other topic. For any threads. Messages and their bytes are reused: no allocation
/// once each slot has held its longest message, for messages of at most Tuning::kept_bytes.
class MessageQueue {
 public:
  explicit MessageQueue(std::size_t capacity = kTuning.queued_samples);  ///< Requires at least 1.

  /// Appends a copy. Never waits for the reader.
  void push(std::size_t topic, std::int64_t source_ns, std::int64_t receive_ns,
            std::span<const std::byte> cdr);

  /// Exchanges `message` for the oldest message; waits for `at_most`. False: none came. Cost:
  /// linear in the number of topics.
  bool pop(TopicSample& message, std::chrono::milliseconds at_most);

  void forget(std::size_t topic);  ///< Drops the messages of a topic and frees their memory.

  std::size_t size() const;    ///< Messages waiting.
  std::uint64_t lost() const;  ///< Messages overwritten before pop().

 private:
  struct Waiting {
    TopicSample message{};
    std::uint64_t number = 0;  // in order of reception
  };
  // Messages of one topic, the oldest at `first`.
  struct Ring {
    std::vector<Waiting> slots{};
    std::size_t first = 0;
    std::size_t size = 0;
    std::size_t bytes = 0;  // of the messages
  };
  Ring& ring_of(std::size_t topic);
  TopicSample& take_oldest(Ring& ring);

  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::map<std::size_t, Ring> rings_;  // by topic
  std::size_t size_ = 0;
  std::uint64_t came_so_far_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace kelpie::dds
