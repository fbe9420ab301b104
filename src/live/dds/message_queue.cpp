// SPDX-License-Identifier: Apache-2.0
#include "dds/message_queue.hpp"

#include <utility>

namespace kelpie::dds {

MessageQueue::MessageQueue(std::size_t capacity) : capacity_(capacity) {}

MessageQueue::Ring& MessageQueue::ring_of(std::size_t topic) {
  Ring& ring = rings_[topic];
  if (ring.slots.empty()) {
    ring.slots.resize(capacity_);
  }
  return ring;
}

void MessageQueue::push(std::size_t topic, std::int64_t source_ns, std::int64_t receive_ns,
                        std::span<const std::byte> cdr) {
  {
    const std::lock_guard lock(mutex_);
    Ring& ring = ring_of(topic);
    if (ring.size == capacity_) {
      ring.first = (ring.first + 1) % capacity_;
      --ring.size;
      --size_;
      ++lost_;
    }
    Waiting& waiting = ring.slots[(ring.first + ring.size) % capacity_];
    waiting.number = came_so_far_++;
    waiting.message.topic = topic;
    waiting.message.source_ns = source_ns;
    waiting.message.receive_ns = receive_ns;
    waiting.message.cdr.assign(cdr.begin(), cdr.end());
    ++ring.size;
    ++size_;
  }
  came_.notify_one();
}

bool MessageQueue::pop(TopicSample& message, std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  if (!came_.wait_for(lock, at_most, [this] { return size_ > 0; })) {
    return false;
  }
  Ring* oldest = nullptr;
  for (auto& [topic, ring] : rings_) {
    if (ring.size > 0 && (oldest == nullptr ||
                          ring.slots[ring.first].number < oldest->slots[oldest->first].number)) {
      oldest = &ring;
    }
  }
  std::swap(message, oldest->slots[oldest->first].message);
  oldest->first = (oldest->first + 1) % capacity_;
  --oldest->size;
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
