// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace kelpie {

/// Stamped values that wait for something, first in, first out. Nothing allocates after
/// construction.
class SampleQueue {
 public:
  /// One of them.
  struct Sample {
    double stamp_s = 0.0;
    double value = 0.0;
  };

  explicit SampleQueue(std::size_t most) : ring_(most) {}  ///< Room for `most`.

  bool is_empty() const { return size_ == 0; }
  bool is_full() const { return size_ == ring_.size(); }
  const Sample& front() const { return ring_[first_]; }  ///< The first. Requires one.
  void reset() { size_ = 0; }                            ///< Forgets them all.

  /// Adds one. Requires room.
  void push(const Sample& sample) {
    ring_[(first_ + size_) % ring_.size()] = sample;
    ++size_;
  }

  /// Takes the first out. Requires one.
  Sample pop() {
    const Sample sample = front();
    first_ = (first_ + 1) % ring_.size();
    --size_;
    return sample;
  }

 private:
  std::vector<Sample> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace kelpie
