// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "log/dataset.hpp"

namespace kelpie::log {

/// How a target goes with the slope of a velocity over the same windows of time.
struct TargetCheck {
  std::string target;
  std::string velocity;
  double correlation = 0.0;  ///< of the target's means with the slopes
  double ratio = 1.0;        ///< standard deviation of the targets over that of the slopes, signed
  double late_s = 0.0;       ///< shift of the target with the largest correlation [s]; 0: none
};

/// Checks the targets that belong to a known velocity: the velocity of the setting `states`, else
/// the input that the target is named after (udot, u_dot or du beside u), but for Dataset::derived,
/// which cannot contradict the velocities. Windows last 1 s and 5 s,
/// at least five rows; the length with the larger correlation counts. A target without a velocity,
/// without motion, or with fewer than 20 windows has no check. Cost O(rows). Allocates.
std::vector<TargetCheck> check_targets(const Dataset& data, const std::string& states);

/// "rdot …; --units r=deg/s converts".
std::string mistake_text(const Mistake& mistake);

/// Mistakes of targets that cannot be the accelerations of their velocities: units (degrees, cm, g,
/// km/h, knots, clocks in ms, µs or ns), a rate or clock that is wrong for all targets, a sign, a
/// target that is late. A target whose correlation with the slopes is below 0.8 shows no mistake,
/// since noise and currents do the same; nor does a factor up to five that no known unit explains,
/// since filters do the same. Cost O(rows). Allocates. Throws what find_states() throws.
std::vector<Mistake> target_mistakes(const Dataset& data, const std::string& states);

/// Dataset::doubts, and mistakes of the clock: stamps equal to the stamp before (refused where more
/// than 30 % are), ten minutes without a row, more than 200 rows per second; and velocities of
/// which a few rows are ten times as far out as all others. Cost O(rows). Allocates.
std::vector<Mistake> clock_mistakes(const Dataset& data);

}  // namespace kelpie::log
