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
  requests_ += row.request ? 1 : 0;
  lock.unlock();
  added_.notify_one();
  return true;
}

bool RowQueue::pop(Row& row) {
  std::unique_lock lock(mutex_);
  added_.wait(lock, [&] { return size_ > 0 || is_closed_; });
  const bool is_late = is_closed_ && Clock::now() >= until_;
  for (; is_late && size_ > 0 && !ring_[first_].request; remove_first()) {
    ++dropped_;
  }
  if (size_ == 0) {
    return false;
  }
  requests_ -= ring_[first_].request ? 1 : 0;
  std::swap(row, ring_[first_]);
  remove_first();
  lock.unlock();
  taken_.notify_one();
  return true;
}

void RowQueue::remove_first() {
  first_ = (first_ + 1) % ring_.size();
  --size_;
}

void RowQueue::close(Clock::time_point until) {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  until_ = until;
  added_.notify_all();
  taken_.notify_all();
}

std::size_t RowQueue::size() const {
  const std::lock_guard lock(mutex_);
  return size_;
}

bool RowQueue::has_request() const {
  const std::lock_guard lock(mutex_);
  return requests_ > 0;
}

std::size_t RowQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace kelpie::live
