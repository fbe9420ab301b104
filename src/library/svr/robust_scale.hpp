// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The usual error, robust to outliers: 1.4826 times the median of the last 256 absolute errors,
/// the standard deviation of Gaussian errors. Allocates nothing.
class RobustScale {
 public:
  /// Known after `least` errors; updated at every `every`-th error. Requires both > 0.
  RobustScale(std::size_t least, std::size_t every) : least_(least), every_(every) {}

  void add(double error);  ///< Cost O(1), O(256) with an update. Requires no NaN.

  /// In the unit of the errors; infinite while unknown.
  double value() const { return value_; }
  std::size_t count() const { return count_; }  ///< errors added

  void clear();  ///< Forgets the errors.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kWindow = 256;

  std::size_t least_;
  std::size_t every_;
  std::array<double, kWindow> errors_{};  ///< the last errors, in a ring
  std::size_t count_ = 0;
  double value_ = std::numeric_limits<double>::infinity();
};

}  // namespace kelpie
