// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "kelpie/core/archive.hpp"
#include "learner/tuning.hpp"

namespace kelpie {

/// Detects grown errors of a model: a CUSUM of errors one step ahead, clipped against outliers. The
/// caller chooses the unit, a usual error. Allocates nothing.
class ErrorAlarm {
 public:
  /// Alarm when the sum exceeds `threshold` [usual errors].
  explicit ErrorAlarm(double threshold) : threshold_(threshold) {}

  /// Adds an error [usual errors] at the time `t` [s]. True while the alarm is on.
  bool watch(double error, double t) {
    since_s_ = sum_ == 0.0 ? t : since_s_;
    sum_ = std::max(0.0, sum_ + std::min(error, kOnline.alarm.clip) - kOnline.alarm.drift);
    return sum_ > threshold_;
  }

  double since() const { return since_s_; }  ///< start of the grown errors [s]
  void reset() { sum_ = 0.0; }               ///< Sets the sum to 0.

  void visit(Archive& archive) {  ///< core/archive.hpp
    archive.number(sum_);
    archive.number(since_s_);
  }

 private:
  double threshold_;
  double sum_ = 0.0;
  double since_s_ = 0.0;
};

}  // namespace kelpie
