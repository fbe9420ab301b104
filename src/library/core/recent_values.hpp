// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
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
  /// Copies the values, the newest first, into the first size() places of `room`, and returns
  /// these.
  std::span<double> copy_to(std::span<double> room) const {
    for (std::size_t i = 0; i < size_; ++i) {
      room[i] = values_[(newest_ + values_.size() - i) % values_.size()];
    }
    return room.first(size_);
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
