// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kelpie/core/archive.hpp"
#include "model/warm_up.hpp"

namespace kelpie {

/// Samples spread evenly over a stretch of a stream of any length: every sample until kMost samples
/// are kept, then every second, fourth, eighth … Allocates in the constructor only.
class ThinnedRows {
 public:
  static constexpr std::size_t kMost = 512;  ///< samples

  explicit ThinnedRows(std::size_t inputs) : rows_(inputs, kMost) {}

  /// Adds a sample. Requires x of `inputs` values. Cost O(1) on average.
  void add(std::span<const double> x, double y, double t);

  std::size_t size() const { return rows_.size(); }
  WarmUp::Sample operator[](std::size_t i) const { return rows_[i]; }  ///< The oldest is 0.

  void drop_oldest(std::size_t samples) { rows_.drop_oldest(samples); }  ///< WarmUp.
  void clear();                                                          ///< Removes all samples.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  WarmUp rows_;
  std::size_t stride_ = 1;
  std::size_t skipped_ = 0;  ///< samples since the last kept sample
};

}  // namespace kelpie
