// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace kelpie::bag {

/// What is told of the values of one quantity, as they come.
class Statistics {
 public:
  static constexpr std::size_t kKept = 512;  ///< differences that the noise is told from, at most

  /// The next value. Cost: O(1).
  void add(double value);

  double low() const { return low_; }    ///< Of the finite values; +inf while there is none.
  double high() const { return high_; }  ///< -inf while there is none.
  std::size_t finite() const { return finite_; }          ///< How many are.
  std::size_t not_finite() const { return not_finite_; }  ///< NaN and infinities.

  /// σ of white noise on the values, in their unit: from the median of what a value lies beside
  /// the line through its neighbours, so that neither slow motion nor single outliers count. 0
  /// where most values lie on it, as those of a coarse resolution do; none: too few values.
  std::optional<double> noise() const;

 private:
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  std::size_t finite_ = 0;
  std::size_t not_finite_ = 0;
  std::array<double, 2> last_{};  // finite ones on end
  std::size_t on_end_ = 0;
  std::vector<double> differences_;  // every stride_-th second difference
  std::size_t stride_ = 1;
  std::size_t met_ = 0;  // second differences
};

}  // namespace kelpie::bag
