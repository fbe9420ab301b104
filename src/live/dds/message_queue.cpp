// SPDX-License-Identifier: Apache-2.0
#include "dds/message_queue.hpp"

#include <utility>

namespace kelpie::dds {
namespace {

void free_if_long(std::vector<std::byte>& bytes) {
  if (bytes.capacity() > kTuning.kept_bytes) {
    std::vector<std::byte>().swap(bytes);
  }
}

}  // namespace

MessageQueue::MessageQueue(std::size_t capacity) : capacity_(capacity) {}

MessageQueue::Ring& MessageQueue::ring_of(std::size_t topic) {
  Ring& ring = rings_[topic];
  if (ring.slots.empty()) {
    ring.slots.resize(capacity_);
  }
  return ring;
}

// The slot of the message that leaves.
TopicSample& MessageQueue::take_oldest(Ring& ring) {
  TopicSample& oldest = ring.slots[ring.first].message;
  ring.first = (ring.first + 1) % capacity_;
  ring.bytes -= oldest.cdr.size();
  --ring.size;
  --size_;
  return oldest;
}

void MessageQueue::push(std::size_t topic, std::int64_t source_ns, std::int64_t receive_ns,
                        std::span<const std::byte> cdr) {
  {
    const std::lock_guard lock(mutex_);
    Ring& ring = ring_of(topic);
    while (ring.size == capacity_ ||
           (ring.size > 0 && ring.bytes + cdr.size() > kTuning.queued_bytes)) {
      free_if_long(take_oldest(ring).cdr);
      ++lost_;
    }
    Waiting& waiting = ring.slots[(ring.first + ring.size) % capacity_];
    waiting.message.cdr.assign(cdr.begin(), cdr.end());
    waiting.number = came_so_far_++;
    waiting.message.topic = topic;
    waiting.message.source_ns = source_ns;
    waiting.message.receive_ns = receive_ns;
    ring.bytes += cdr.size();
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
  free_if_long(message.cdr);
  std::swap(message, take_oldest(*oldest));
  return true;
}

void MessageQueue::forget(std::size_t topic) {
  const std::lock_guard lock(mutex_);
  if (const auto ring = rings_.find(topic); ring != rings_.end()) {
    size_ -= ring->second.size;
    rings_.erase(ring);
  }
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
