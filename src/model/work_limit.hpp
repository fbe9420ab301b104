// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/budget.hpp"

namespace kelpie {

/// How much work an update of all axes together may be (docs/performance.md). What is beyond that
/// is left to the next updates, as with a Budget of the user's. Counted, not timed: the same log
/// gives the same model everywhere. Every sample that has to be turned away for it lets the limit
/// grow by half a percent, which is lost again over thousands of updates: where updates usually are
/// more work, as with a very small ε, one sample in forty is turned away at most.
class WorkLimit {
 public:
  /// For so many axes, whose largest buffer has room for so many samples.
  WorkLimit(std::size_t axes, std::size_t places);

  /// What an axis may spend of the update at hand, beside `budget`: the axes that follow keep half
  /// of an equal share each. To be called for one axis after the other. Refers to this object, and
  /// is good until learned().
  Budget grant(const Budget& budget, std::size_t followers);

  /// The update is over; whether it had to turn a sample away.
  void learned(bool crowded_out);

  Work most() const { return most_; }  ///< of the next update

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t axes_;
  Work least_;
  Work most_;
  Work left_;  ///< of this update
};

}  // namespace kelpie
