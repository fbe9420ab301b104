// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// A vehicle file without head, for read_vehicle() (reference/simulator.md): numbers with six
/// digits, directions exact. Requires a vehicle that passes validate().
std::string vehicle_text(const VehicleParameters& vehicle);

}  // namespace kelpie::simulator
