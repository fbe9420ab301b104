// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace kelpie::bag {

/// Running statistics of a quantity.
class Statistics {
 public:
  /// The next value. Cost: O(1).
  void add(double value);

  double low() const { return low_; }    ///< Of the finite values; +inf without finite values.
  double high() const { return high_; }  ///< -inf without finite values.
  std::size_t finite() const { return finite_; }          ///< How many are.
  std::size_t not_finite() const { return not_finite_; }  ///< NaN and infinities.

  /// σ of white noise on the values, in the values' unit: from the median distance of a value to
  /// the line through both neighbours, so that slow motion and single outliers do not count. 0 if
  /// most values lie on the line (coarse resolution); empty: too few values.
  std::optional<double> noise() const;

 private:
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  std::size_t finite_ = 0;
  std::size_t not_finite_ = 0;
  std::array<double, 2> last_{};  // consecutive finite values
  std::size_t on_end_ = 0;
  std::vector<double> differences_;  // every stride_-th second difference
  std::size_t stride_ = 1;
  std::size_t met_ = 0;  // second differences
};

}  // namespace kelpie::bag
