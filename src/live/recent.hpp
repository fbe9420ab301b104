// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace kelpie::live {

/// The last values of a quantity, at most `capacity`.
template <typename T>
class Recent {
 public:
  explicit Recent(std::size_t capacity) : capacity_(capacity) { values_.reserve(capacity); }

  void add(const T& value) {
    if (values_.size() < capacity_) {
      values_.push_back(value);
    } else {
      values_[next_] = value;
      next_ = (next_ + 1) % capacity_;
    }
  }
  const std::vector<T>& values() const { return values_; }  ///< Unordered.

 private:
  std::size_t capacity_;
  std::vector<T> values_;
  std::size_t next_ = 0;
};

}  // namespace kelpie::live
