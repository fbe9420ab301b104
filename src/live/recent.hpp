// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kelpie/online/decision.hpp"

namespace kelpie::live {

/// The last values of a quantity, for yardsticks of the last minutes.
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

/// What was said of a sample before it was learned, and what it was.
struct Said {
  double predicted = 0.0;
  double truth = 0.0;
  bool is_inside = false;  ///< the interval
};

/// R² of these predictions; NaN where the truth doesn't vary.
double r_squared(const std::vector<Said>& samples);
/// The share inside their interval; NaN of none.
double coverage(const std::vector<Said>& samples);

}  // namespace kelpie::live
