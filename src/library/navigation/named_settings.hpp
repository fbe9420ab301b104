// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kelpie/navigation/dead_reckoning.hpp"

namespace kelpie {

/// Settings by the names of a model's velocities (OpenLoop::axes): planar where the first three are
/// surge, sway and yaw rate, and the angular velocities a gyro's (`rates`) beside others.
DeadReckoningSettings named_settings(const OpenLoop& model);

/// Whether the first three velocities may be surge, sway and yaw rate: no name says otherwise.
bool may_be_planar(const OpenLoop& model);

}  // namespace kelpie
