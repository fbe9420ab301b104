// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/svr/settings.hpp"
#include "svr/robust_scale.hpp"
#include "svr/sample_collector.hpp"
#include "svr/tuning.hpp"

namespace kelpie {

/// The outlier rejection node: flags support vectors for removal after training. Allocates in the
/// constructor only.
///
/// `iqr` (eq. 12 as written): residuals outside [q1 − 1.5 (q3 − q1), q3 + 1.5 (q3 − q1)]. Free
/// support vectors have |e| = ε; with few support vectors at the bound the quartiles collapse to
/// ±ε, and the rule flags every support vector at the bound: see docs/method/learner.md.
///
/// `robust`: a support vector is an outlier if its weight is at ±C, that is, its neighbours
/// contradict the sample up to the bound, and its residual exceeds ε + factor · s. The scale s is
/// the RobustScale of the errors one step ahead in the stream. s grows with a change of the
/// vehicle; a change therefore produces no outliers.
class OutlierFilter {
 public:
  explicit OutlierFilter(const OnlineSvrSettings& settings);  ///< Requires settings that validate.

  /// Adds the error y − f(x) of a sample before learning.
  void observe(double error) { scale_.add(error); }

  /// The numbers of the samples to remove in descending order, stable under removal. Valid until
  /// the next call. `bias`: b of the trained model. Cost O(n).
  std::span<const std::size_t> find_outliers(const SampleCollector& buffer, double bias);

  void clear() { scale_.clear(); }  ///< Forgets the errors.

  void visit(Archive& archive) { scale_.visit(archive); }  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(const OnlineSvrSettings& settings);

 private:
  OutlierRule rule_;
  double factor_;
  RobustScale scale_{kSvr.outlier_least, kSvr.outlier_every};  ///< s, of the errors one step ahead
  RoomyVector<double> scratch_;
  RoomyVector<std::size_t> flagged_;
};

}  // namespace kelpie
