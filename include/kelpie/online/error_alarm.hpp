// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "kelpie/core/archive.hpp"
#include "online/tuning.hpp"

namespace kelpie {

/// Tells that a model's errors have grown: a CUSUM of errors one step ahead, each clipped, so that
/// outliers don't count much. Their unit, the usual error, is the caller's choice. Allocates
/// nothing.
class ErrorAlarm {
 public:
  /// Goes off when the sum exceeds `threshold`, in usual errors.
  explicit ErrorAlarm(double threshold) : threshold_(threshold) {}

  /// One more error, in usual ones; `t` is its time [s]. True while the alarm is on.
  bool watch(double error, double t) {
    since_s_ = sum_ == 0.0 ? t : since_s_;
    sum_ = std::max(0.0, sum_ + std::min(error, kOnline.alarm.clip) - kOnline.alarm.drift);
    return sum_ > threshold_;
  }

  double since() const { return since_s_; }  ///< when errors began to grow [s]
  void reset() { sum_ = 0.0; }               ///< Begins anew.

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
