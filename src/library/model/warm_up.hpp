// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The last `most` samples of one axis in order, before the scale is known. Allocates in the
/// constructor only.
class WarmUp {
 public:
  /// A sample.
  struct Sample {
    std::span<const double> x;  ///< valid until the next change
    double y = 0.0;
    double t = 0.0;
  };

  WarmUp(std::size_t inputs, std::size_t most);  ///< Room for `most` samples.

  /// Adds a sample; without room, removes the oldest. Requires x of `inputs` values, and most > 0.
  void hold(std::span<const double> x, double y, double t);

  std::size_t size() const { return rows_.size() / width_; }
  bool full() const { return size() == most_; }
  Sample operator[](std::size_t i) const;  ///< The oldest is 0.

  void drop_oldest(
      std::size_t samples);  ///< Removes the oldest samples. Requires samples <= size().
  void keep(
      const std::vector<bool>& samples);  ///< Removes samples marked false. Requires size() marks.

  void clear() { rows_ = {}; }  ///< Removes all samples and frees the memory.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t width_;  ///< numbers per sample: x, y, t
  std::size_t most_;
  RoomyVector<double> rows_;
};

}  // namespace kelpie
