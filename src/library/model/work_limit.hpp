// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kelpie/core/archive.hpp"
#include "kelpie/svr/resources.hpp"

namespace kelpie {

/// The largest work of an update of all axes together (measured/performance.md). Work beyond it
/// is left to the next updates, as with a Budget. Work is counted, not timed: the same log gives
/// the same model everywhere. Every sample rejected for lack of work raises the limit by half a
/// percent, which decays over thousands of updates: with usually larger work, as with a very small
/// ε, at most one sample in forty is rejected.
class WorkLimit {
 public:
  /// `places`: samples in the largest buffer.
  WorkLimit(std::size_t axes, std::size_t places);

  /// The budget of one axis in the update at hand, within `budget`: each following axis keeps half
  /// of an equal share. To be called for one axis after the other. Refers to this object; valid
  /// until learned().
  Budget grant(const Budget& budget, std::size_t followers);

  /// Ends the update; `crowded_out`: whether an axis rejected the sample for lack of work.
  void learned(bool crowded_out);

  Work most() const { return most_; }  ///< Of the next update.

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t axes_;
  Work least_;
  Work most_;
  Work left_;  ///< of this update
};

}  // namespace kelpie
