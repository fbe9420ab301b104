// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace kelpie::live {

/// The last values of a quantity, for baselines of the last minutes.
template <typename T>
class Recent {
 public:
  explicit Recent(std::size_t most) : most_(most) { values_.reserve(most); }

  void add(const T& value) {
    if (values_.size() < most_) {
      values_.push_back(value);
    } else {
      values_[next_] = value;
      next_ = (next_ + 1) % most_;
    }
  }
  const std::vector<T>& values() const { return values_; }  ///< In no order.

 private:
  std::size_t most_;
  std::vector<T> values_;
  std::size_t next_ = 0;
};

}  // namespace kelpie::live
