// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/decision.hpp"
#include "model/access_guard.hpp"

namespace kelpie {

/// The clock of a model; model time never goes back. Where the time stamps of samples step back (a
/// corrected clock, another log), model time stands still for this step and continues from there.
class ModelClock {
 public:
  double at(double t);  ///< The model time [s] of the sample stamped `t` [s].

  /// The stamp of a model time, by the clock of the latest sample.
  double stamp(double at) const { return at - offset_; }

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  double offset_ = 0.0;
  double last_ = -std::numeric_limits<double>::infinity();
};

/// The state of every OnlineModel between updates, and the steps of update() that all share.
struct UpdateState {
  explicit UpdateState(std::size_t axes) : decisions(axes) {}

  AccessGuard access;
  ModelClock clock;
  std::vector<Decision> decisions;  ///< one per axis

  /// Alerts all axes without news of a change to every change that the others found. `learner(i)`
  /// is an OnlineRegressor&.
  template <typename Learner>
  void share_changes(Learner learner) {
    for (const Decision& found : decisions) {
      // The others hear of a return when it is found, not when the past model is ready.
      const bool news = found.returning || (found.changed && found.recalled == 0);
      for (std::size_t i = 0; news && i < decisions.size(); ++i) {
        if (!decisions[i].changed && !decisions[i].returning) {
          learner(i).alert(found.changed_since, !found.returning);
        }
      }
    }
  }

  bool crowded_out() const;  ///< Whether an axis rejected the sample for lack of work.

  /// Puts the times in the decisions from model time to time stamps.
  void stamp_changes();
};

}  // namespace kelpie
