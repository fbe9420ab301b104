// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// Names in files, in the order of ThrusterIndex.
const std::array<std::string, kThrusterCount>& thruster_names();

/// K± n|n|, in N.
double thrust(const Thruster& thruster, double speed_rps);

/// The speed for `force_n`, clamped to ±max_speed_rps.
double speed_for_thrust(const Thruster& thruster, double force_n);

/// Force and moment of one newton of thrust: direction, and position × direction.
Vector6 thrust_axis(const Thruster& thruster);

}  // namespace kelpie::vehicle
