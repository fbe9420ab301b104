// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "log/candidates.hpp"

namespace kelpie::log {

/// Short names for commands, all different, of letters, digits and "_": what of each column's words
/// the others don't all have. "/thruster_left/cmd:data" beside "/thruster_right/cmd:data" is left;
/// "SERVO_OUTPUT_RAW:servo1_raw" alone is servo1_raw.
std::vector<std::string> short_names(const std::vector<CandidateColumn>& columns);

}  // namespace kelpie::log
