// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/online/robust_scale.hpp"
#include "kelpie/online/sample_collector.hpp"
#include "kelpie/online/settings.hpp"
#include "online/tuning.hpp"

namespace kelpie {

/// The outlier rejection node: looks over the support vectors after training and flags those to be
/// removed. Allocates in the constructor only.
///
/// `iqr` (eq. 12 as written): residuals outside [q1 − 1.5 (q3 − q1), q3 + 1.5 (q3 − q1)]. All free
/// support vectors have |e| = ε, so the quartiles collapse to ±ε whenever few are at the bound, and
/// the rule then flags all of these: see docs/method.md.
///
/// `robust`: a support vector is an outlier when its weight is at ±C, i.e. its neighbours
/// contradict it as much as C allows, and its residual exceeds ε + factor · s. The scale s is taken
/// from the stream, not from the buffer: the RobustScale of the errors one step ahead, which grows
/// by itself when the vehicle changes, so that a change isn't mistaken for outliers.
class OutlierFilter {
 public:
  explicit OutlierFilter(const OnlineSvrSettings& settings);  ///< Requires settings that validate.

  /// Tells the error y − f(x) of a sample before it was learned.
  void observe(double error) { scale_.add(error); }

  /// The numbers of the samples to remove, highest first, so that removing one leaves the numbers
  /// of the rest. Valid until the next call. `bias` is b of the model just trained. Cost O(n).
  std::span<const std::size_t> find_outliers(const SampleCollector& buffer, double bias);

  void clear() { scale_.clear(); }  ///< Forgets all errors.

  void visit(Archive& archive) { scale_.visit(archive); }  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(const OnlineSvrSettings& settings);

 private:
  OutlierRule rule_;
  double factor_;
  RobustScale scale_{kOnline.paper.outlier_least,
                     kOnline.paper.outlier_every};  ///< s, of the errors one step ahead
  std::vector<double> scratch_;
  std::vector<std::size_t> flagged_;
};

}  // namespace kelpie
