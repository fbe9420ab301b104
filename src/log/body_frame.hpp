// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "log/sampling.hpp"

namespace kelpie::log {

/// Brings the plan's vectors into their frames, then takes the lever arm out of the velocity, rates
/// between their samples on a line (no value where they are silent). Sorts all signals by time.
/// Throws InputError (from) when the components of a vector have different stamps.
void to_body_frame(const SamplingPlan& plan, std::vector<Signal>& signals);

}  // namespace kelpie::log
