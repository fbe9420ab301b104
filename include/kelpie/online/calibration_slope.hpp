// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// How much of what was said beyond the mean came true: the slope of the line through 0 that leads
/// from what was said of the last samples to what they were (Cox 1958: calibration slope). 1: all
/// of it; near 0: it was noise that had been learned.
///
///     slope = (Σ λ^age s y + w) / (Σ λ^age s² + w),  0.05 … 1,  s and y within ±3
///
/// The weight w of the belief in 1 is that of ten samples of usual size. Allocates nothing.
class CalibrationSlope {
 public:
  static constexpr double kLeast = 0.05;  ///< with less it couldn't be told when it rises again

  /// `said` of a sample before it was learned and what it `was`, both beyond the mean [standard
  /// deviations].
  void add(double said, double was);

  double value() const;

  void halve();  ///< What was told counts half from now on.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  double product_ = 0.0;
  double square_ = 0.0;
};

}  // namespace kelpie
