// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kelpie {

/// Work counted in numbers looked at, the same on every machine: 0.2 to 0.5 ns each on that of
/// docs/performance.md.
using Work = std::int64_t;

/// What a caller grants for one update: a number of steps, a clock of its own, work that several
/// share, or all of them. Spent by every solve that it is handed to; a default one never ends.
class Budget {
 public:
  Budget() = default;
  explicit Budget(int max_steps) : steps_(max_steps) {}  ///< So many steps, without a clock.
  /// `expired(context)` is asked before every step, so it should be cheap.
  Budget(int max_steps, bool (*expired)(void*), void* context)
      : steps_(max_steps), expired_(expired), context_(context) {}

  /// Whether there is something left; once there isn't, never again.
  bool goes_on() {
    exhausted_ = exhausted_ || steps_ <= 0 || (work_ != nullptr && *work_ <= kept_) ||
                 (expired_ != nullptr && expired_(context_));
    return !exhausted_;
  }

  /// Takes one step of so much work from the budget; false, and from then on, when there is none.
  bool spend(std::size_t work = 0) {
    if (!goes_on()) {
      return false;
    }
    if (steps_ != kNoLimit) {
      --steps_;
    }
    charge(work);
    return true;
  }

  /// Takes work that nobody asks for beforehand.
  void charge(std::size_t work) const {
    if (work_ != nullptr) {
      *work_ -= static_cast<Work>(work);
    }
  }

  bool exhausted() const { return exhausted_; }

  /// The same with `most` steps at most.
  Budget within(int most) const {
    Budget part = *this;
    part.steps_ = std::min(steps_, most);
    return part;
  }

  /// The same, which also ends where so little of the shared work is left as `kept`. The number
  /// has to outlive it.
  Budget sharing(Work& left, Work kept) const {
    Budget part = *this;
    part.work_ = &left;
    part.kept_ = kept;
    return part;
  }

  /// The same, which leaves half of the shared work that there is now to somebody else.
  Budget split_half() const {
    Budget part = *this;
    if (work_ != nullptr && *work_ > kept_) {
      part.kept_ += (*work_ - kept_) / 2;
    }
    return part;
  }

 private:
  static constexpr int kNoLimit = std::numeric_limits<int>::max();

  int steps_ = kNoLimit;
  bool (*expired_)(void*) = nullptr;
  void* context_ = nullptr;
  Work* work_ = nullptr;
  Work kept_ = 0;
  bool exhausted_ = false;
};

}  // namespace kelpie
