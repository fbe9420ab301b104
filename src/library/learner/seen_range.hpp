// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "svr/function_mix.hpp"

namespace kelpie {

/// The range of the seen values of a target or physics term: from the third smallest to the third
/// largest value, against outliers, with a margin on either side. Before kLeast values: from the
/// smallest to the largest, with a margin of a standard deviation. Allocates nothing.
class SeenRange {
 public:
  /// `margin`: on either side, relative to the width of the range.
  explicit SeenRange(double margin) : margin_(margin) {}

  void add(double y);  ///< Requires no NaN.

  ValueRange range() const;  ///< Infinite before the first value.

  /// Values y become gain · y + offset. Requires gain > 0.
  void rescale(double gain, double offset);

  void clear() { count_ = 0; }  ///< Forgets the values.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kEnds = 3;
  static constexpr std::size_t kLeast = 20;

  double margin_;
  std::array<double, kEnds> least_{};     ///< ascending
  std::array<double, kEnds> greatest_{};  ///< descending
  std::size_t count_ = 0;
};

/// The ranges of the seen values of all physics terms of a sample. Adding allocates nothing.
class SeenTermRanges {
 public:
  explicit SeenTermRanges(std::size_t terms);

  /// The ranges, in the order of the terms. Valid until the next other call.
  const std::vector<ValueRange>& ranges() const { return ranges_; }

  /// Adds the terms of a sample `z`, the last numbers of z. Requires no NaN.
  void add(std::span<const double> z);

  /// Every term becomes factor · term. Requires a factor > 0 per term.
  void rescale(std::span<const double> factors);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t terms) {
    return terms * (sizeof(SeenRange) + sizeof(ValueRange));
  }

 private:
  void measure();

  std::vector<SeenRange> seen_;
  std::vector<ValueRange> ranges_;  ///< of seen_
};

}  // namespace kelpie
