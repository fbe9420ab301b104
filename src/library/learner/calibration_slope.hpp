// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// The calibration slope of recent predictions (Cox 1958): the slope of the line through 0 from
/// predicted to true deviations from the mean. 1: unbiased predictions; near 0: learned noise.
///
///     slope = (Σ λ^age s y + w) / (Σ λ^age s² + w),  0.05 … 1,  s and y within ±3
///
/// The prior is slope 1 with the weight w of ten samples of unit size. Allocates nothing.
class CalibrationSlope {
 public:
  static constexpr double kLeast = 0.05;  ///< a smaller slope would leave no signal of a later rise

  /// Adds the predicted value `said` and the true value `was` of a sample, as deviations from the
  /// mean [standard deviations].
  void add(double said, double was);

  double value() const;

  void halve();  ///< Halves the weight of the evidence.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  double product_ = 0.0;
  double square_ = 0.0;
};

}  // namespace kelpie
