// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The last values of a sequence, up to a number that is fixed at construction, the newest first.
/// Only the constructor allocates.
class RecentValues {
 public:
  /// Requires most > 0.
  explicit RecentValues(std::size_t most) : values_(most) {}

  void add(double value) {
    newest_ = (newest_ + 1) % values_.size();
    values_[newest_] = value;
    size_ = std::min(size_ + 1, values_.size());
  }
  std::size_t size() const { return size_; }
  /// The i-th value from the newest, 0. Requires i < size().
  double operator[](std::size_t i) const {
    return values_[(newest_ + values_.size() - i) % values_.size()];
  }
  /// Forgets all but the newest values.
  void keep(std::size_t newest) { size_ = std::min(size_, newest); }

  void visit(Archive& archive) {  ///< core/archive.hpp
    archive.numbers(values_);
    archive.whole(newest_, std::size_t{0}, values_.size() - 1);
    archive.whole(size_, std::size_t{0}, values_.size());
  }

 private:
  std::vector<double> values_;
  std::size_t newest_ = 0;
  std::size_t size_ = 0;
};

}  // namespace kelpie
