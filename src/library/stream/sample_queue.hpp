// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace kelpie {

/// First-in, first-out queue of stamped values. Allocates at construction only.
class SampleQueue {
 public:
  /// A stamped value.
  struct Sample {
    double stamp_s = 0.0;
    double value = 0.0;
  };

  explicit SampleQueue(std::size_t most) : ring_(most) {}  ///< Room for `most` samples.

  bool is_empty() const { return size_ == 0; }
  bool is_full() const { return size_ == ring_.size(); }
  const Sample& front() const { return ring_[first_]; }  ///< The oldest. Requires a sample.
  void reset() { size_ = 0; }

  void push(const Sample& sample) {  ///< Requires room.
    ring_[(first_ + size_) % ring_.size()] = sample;
    ++size_;
  }

  Sample pop() {  ///< Removes the oldest. Requires a sample.
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
