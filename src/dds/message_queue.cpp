// SPDX-License-Identifier: Apache-2.0
#include "dds/message_queue.hpp"

#include <utility>

namespace kelpie::dds {

MessageQueue::MessageQueue(std::size_t capacity) : ring_(capacity) {}

void MessageQueue::put(std::size_t topic, std::int64_t source_ns, std::int64_t receive_ns,
                       std::span<const std::byte> cdr) {
  {
    const std::lock_guard lock(mutex_);
    if (size_ == ring_.size()) {
      first_ = (first_ + 1) % ring_.size();
      --size_;
      ++lost_;
    }
    Message& message = ring_[(first_ + size_) % ring_.size()];
    message.topic = topic;
    message.source_ns = source_ns;
    message.receive_ns = receive_ns;
    message.cdr.assign(cdr.begin(), cdr.end());
    ++size_;
  }
  came_.notify_one();
}

bool MessageQueue::take(Message& message, std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  if (!came_.wait_for(lock, at_most, [this] { return size_ > 0; })) {
    return false;
  }
  std::swap(message, ring_[first_]);
  first_ = (first_ + 1) % ring_.size();
  --size_;
  return true;
}

std::size_t MessageQueue::size() const {
  const std::lock_guard lock(mutex_);
  return size_;
}

std::uint64_t MessageQueue::lost() const {
  const std::lock_guard lock(mutex_);
  return lost_;
}

}  // namespace kelpie::dds
