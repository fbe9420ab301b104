// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "kelpie/online/sample_collector.hpp"
#include "kelpie/online/settings.hpp"

namespace kelpie {

/// The outlier rejection node: looks over the support vectors after training and flags those to be
/// removed. Allocates in the constructor only.
///
/// `iqr` (eq. 12 as written): residuals outside [q1 − 1.5 (q3 − q1), q3 + 1.5 (q3 − q1)]. All free
/// support vectors have |e| = ε, so the quartiles collapse to ±ε whenever few are at the bound, and
/// the rule then takes everyone who is: see docs/method.md.
///
/// `robust`: a support vector is an outlier when its weight is at ±C, i.e. its neighbours
/// contradict it at the full price, and its residual exceeds ε + factor · s. The scale s is taken
/// from the stream, not from the buffer: 1.4826 times the median of the last one-step-ahead errors,
/// which grows by itself when the vehicle changes, so that a change isn't mistaken for outliers.
class OutlierFilter {
 public:
  explicit OutlierFilter(const OnlineSvrSettings& settings);  ///< Requires settings that validate.

  /// Tells the error y − f(x) of a sample before it was learned.
  void observe(double error);

  /// The numbers of the samples to remove, highest first, so that removing one leaves the numbers
  /// of the rest. Valid until the next call. `bias` is b of the model just trained. Cost O(n).
  std::span<const std::size_t> judge(const SampleCollector& buffer, double bias);

  /// s, or infinity until enough errors were observed to tell.
  double usual_error() const { return usual_; }

  void clear();  ///< Forgets all errors.

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(const OnlineSvrSettings& settings);

 private:
  static constexpr std::size_t kWindow = 256;
  static constexpr std::size_t kEnough = 64;
  static constexpr std::size_t kEvery = 8;  ///< errors between two looks at their median

  OutlierRule rule_;
  double factor_;
  std::array<double, kWindow> errors_{};  ///< the last ones, in a ring
  std::size_t observed_ = 0;
  double usual_ = std::numeric_limits<double>::infinity();
  std::vector<double> scratch_;
  std::vector<std::size_t> flagged_;
};

}  // namespace kelpie
