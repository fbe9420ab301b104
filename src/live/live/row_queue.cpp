// SPDX-License-Identifier: Apache-2.0
#include "live/row_queue.hpp"

#include <utility>

namespace kelpie::live {

bool RowQueue::push(const Row& row, bool wait) {
  std::unique_lock lock(mutex_);
  if (wait) {
    taken_.wait(lock, [&] { return size_ < ring_.size() || is_closed_; });
  }
  if (is_closed_) {
    return false;
  }
  if (size_ == ring_.size()) {
    ++dropped_;
    return false;
  }
  ring_[(first_ + size_) % ring_.size()] = row;
  ++size_;
  lock.unlock();
  added_.notify_one();
  return true;
}

bool RowQueue::pop(Row& row) {
  std::unique_lock lock(mutex_);
  added_.wait(lock, [&] { return size_ > 0 || is_closed_; });
  if (size_ == 0) {
    return false;
  }
  std::swap(row, ring_[first_]);
  first_ = (first_ + 1) % ring_.size();
  --size_;
  lock.unlock();
  taken_.notify_one();
  return true;
}

void RowQueue::close() {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  added_.notify_all();
  taken_.notify_all();
}

std::size_t RowQueue::size() const {
  const std::lock_guard lock(mutex_);
  return size_;
}

std::size_t RowQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace kelpie::live
