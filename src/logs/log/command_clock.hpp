// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "log/dataset.hpp"

namespace kelpie::log {

/// A clock of the commands that is off: the accelerations go with commands logged 3 to 30 s later
/// or earlier (a sixth of the log at most) clearly better than with the commands `align_s` later,
/// as they are to be taken.
///
/// Means of the rows over 1 s are fitted by least squares on v, v|v|, vᵢvⱼ and angles, then on n
/// and n|n| of all commands, shifted. Shifts up to 3 s are of thrusters and feedback, and so is a
/// fit on the commands with four first-order lags up to 24 s; the errors of the fits have Akaike's
/// penalty (1974). Both halves of the log have to agree in the shift, and the commands have to
/// leave 18 % less unexplained (in logarithms, over all targets), for a refusal 40 %. On all logs
/// at hand, whole or in six parts, and on simulated ships under feedback the gain is below 3 %.
///
/// Empty without commands or velocities by `states` (find_states()), and below three minutes. Cost:
/// 65 fits to at most 20,000 means. Allocates.
std::optional<Mistake> command_clock_mistake(const Dataset& data, const std::string& states,
                                             double align_s);

}  // namespace kelpie::log
