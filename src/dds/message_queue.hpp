// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace kelpie::dds {

/// A message as it came.
struct Message {
  std::size_t topic = 0;         ///< the number its Subscription was given
  std::int64_t source_ns = 0;    ///< when it was published, by the publisher's clock, since 1970
  std::int64_t receive_ns = 0;   ///< when it came, by this machine's clock, since 1970
  std::vector<std::byte> cdr{};  ///< with the four bytes of its encapsulation, as in bags
};

/// A bounded queue between those who receive and one who takes. Full, it loses the oldest message,
/// so that whoever falls behind goes on with what is new. Safe to share between threads. Messages
/// and their bytes are kept and used again: once all have had their longest message, nothing
/// allocates.
class MessageQueue {
 public:
  explicit MessageQueue(std::size_t capacity = 1000);  ///< Requires at least 1.

  /// Appends a copy; never waits for the taker.
  void put(std::size_t topic, std::int64_t source_ns, std::int64_t receive_ns,
           std::span<const std::byte> cdr);

  /// Exchanges `message` for the oldest one. Waits `at_most` for it; false where none came.
  bool take(Message& message, std::chrono::milliseconds at_most);

  std::size_t size() const;    ///< Messages waiting.
  std::uint64_t lost() const;  ///< Messages that were overwritten before they were taken.

 private:
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Message> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace kelpie::dds
