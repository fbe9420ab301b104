// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "navigation/velocity_filter.hpp"

namespace kelpie {

/// Recognises velocities that a sensor didn't measure: exact zeros and repeated values of all
/// velocities but the yaw rate of planar motion, and single velocities that stay constant while the
/// others change. The equations of motion, under the present commands, tell a vehicle at rest from
/// a sensor that has stopped. Allocates nothing.
class VelocityCheck {
 public:
  using Faults = std::array<VelocityFault, VelocityFilter::kMostVelocities>;

  /// Faults of a sample at the time t [s]; `filter` is the estimate before. Requires times that
  /// never decrease.
  Faults judge(std::span<const double> x, double t, VelocityFilter& filter);

 private:
  using Values = std::array<double, VelocityFilter::kMostVelocities>;

  static bool contradicts(const VelocityFilter& filter, const Values& now);
  static bool is_still(const VelocityFilter& filter, const Values& now);
  static bool would_move(VelocityFilter& filter, const Values& now);
  VelocityFault judge_all(const VelocityFilter& filter, const Values& now, bool is_zero, double t);
  bool is_one_frozen(VelocityFilter& filter, const Values& now, std::size_t state, double t) const;
  double frozen_after_s() const;
  void remember(const Values& now, double t);

  Values last_{};                                                     // values of the last samples
  Values changed_s_{};                                                // when the last value came
  std::array<std::size_t, VelocityFilter::kMostVelocities> equal_{};  // samples since
  bool has_last_ = false;
  bool in_stretch_ = false;    // of repeated values or zeros
  bool contradicted_ = false;  // the vehicle moved in this stretch
  double stretch_s_ = 0.0;     // when the stretch began
  double usual_s_ = 0.0;       // fading mean of the time between two changes
};

}  // namespace kelpie
