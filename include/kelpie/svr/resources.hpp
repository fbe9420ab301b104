// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kelpie {

/// Number format of a kernel matrix.
enum class Storage : std::uint8_t {
  float64,  ///< as computed
  float32,  ///< rounded to 24 bits, half the memory
};

/// Work, counted in visited numbers: equal on every machine, 0.2 to 0.5 ns per number on the
/// machine of docs/measured/performance.md.
using Work = std::int64_t;

/// The limits of one update: a number of steps, a clock of the caller, shared work, or a
/// combination. Solves spend the budget; a default budget is unlimited.
class Budget {
 public:
  Budget() = default;
  explicit Budget(int max_steps) : steps_(max_steps) {}  ///< A limit of steps, without a clock.
  /// Calls `expired(context)` before every step; the function should be cheap.
  Budget(int max_steps, bool (*expired)(void*), void* context)
      : steps_(max_steps), expired_(expired), context_(context) {}

  /// Whether the budget is not exhausted. An exhausted budget stays exhausted.
  bool goes_on() {
    exhausted_ = exhausted_ || steps_ <= 0 || (work_ != nullptr && *work_ <= kept_) ||
                 (expired_ != nullptr && expired_(context_));
    return !exhausted_;
  }

  /// Spends one step of `work`; false for an exhausted budget.
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

  /// Spends work without a check.
  void charge(std::size_t work) const {
    if (work_ != nullptr) {
      *work_ -= static_cast<Work>(work);
    }
  }

  bool exhausted() const { return exhausted_; }

  /// A copy with at most `most` steps.
  Budget within(int most) const {
    Budget part = *this;
    part.steps_ = std::min(steps_, most);
    return part;
  }

  /// A copy that also ends when the shared work `left` falls to `kept`. `left` has to outlive the
  /// copy.
  Budget sharing(Work& left, Work kept) const {
    Budget part = *this;
    part.work_ = &left;
    part.kept_ = kept;
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
