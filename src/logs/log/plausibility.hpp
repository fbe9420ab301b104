// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "log/dataset.hpp"

namespace kelpie::log {

/// "rdot …; --units r=deg/s converts".
std::string mistake_text(const Mistake& mistake);

/// Mistakes of targets that cannot be the accelerations of their velocities (the velocity of the
/// setting `states`, else the input that the target is named after: udot, u_dot or du beside u),
/// but for Dataset::derived: units (degrees, cm, g, km/h, knots, clocks in ms, µs or ns), a rate or
/// clock that is wrong for all targets, a sign, another velocity's acceleration, an offset, gravity
/// beside the sine of pitch or roll, a target that is late. Windows last 1 s and 5 s, at least five
/// rows; the length with the larger correlation counts; 20 windows at least. A target whose
/// correlation with the slopes is below 0.8 shows no mistake, since noise and currents do the same;
/// nor does a factor up to five that no known unit explains, since filters do the same. And
/// command_clock_mistake(), where commands are to be taken `align_s` later. Cost O(rows).
/// Allocates. Throws what find_states() throws.
std::vector<Mistake> target_mistakes(const Dataset& data, const std::string& states,
                                     double align_s = 0.0);

/// Dataset::doubts, and mistakes of the clock: stamps equal to the stamp before (refused where more
/// than 30 % are), ten minutes without a row, more than 200 rows per second; and velocities of
/// which a few rows are ten times as far out as all others, or that hardly any vehicle has (turning
/// refused beyond three times the limit). Cost O(rows). Allocates.
std::vector<Mistake> clock_mistakes(const Dataset& data);

/// Both.
std::vector<Mistake> all_mistakes(const Dataset& data, const std::string& states);

}  // namespace kelpie::log
