// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "core/seconds.hpp"
#include "live/checkpoint.hpp"

namespace kelpie::live {

/// Times at which the messages of a recording are due, by the steps between their stamps of
/// reception. A step back, and a step of more than LearningClock::kLongestPause, is a clock that
/// was set, and takes no time.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Pace(double speed) : speed_(speed) {}  ///< Requires a speed > 0, which may be infinite.

  /// When the next message is due; the first message is due at `begin`.
  Clock::time_point next(std::int64_t receive_ns, Clock::time_point begin) {
    const double step_s = has_begun_ ? seconds(receive_ns - before_ns_) : 0.0;
    due_ = has_begun_ ? due_ : begin;
    has_begun_ = true;
    before_ns_ = receive_ns;
    if (step_s > 0.0 && step_s <= LearningClock::kLongestPause) {
      due_ += std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(std::min(step_s / speed_, kLongestStepS)));
    }
    return due_;
  }

 private:
  static constexpr double kLongestStepS = 1e8;  // of a slow replay; sums stay within the clock

  double speed_;
  bool has_begun_ = false;
  std::int64_t before_ns_ = 0;
  Clock::time_point due_;
};

}  // namespace kelpie::live
