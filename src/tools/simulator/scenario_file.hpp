// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "file/toml.hpp"
#include "simulator/parameters.hpp"
#include "simulator/scenario.hpp"

namespace kelpie::simulator {

// Keys, units and defaults: reference/simulator.md. Both throw InputError (file, line, key) on a
// file that is missing or no TOML, a key that is unknown or missing, a value of the wrong type or
// shape, a number that is not finite, and whatever validate() rejects.

VehicleParameters read_vehicle(const std::filesystem::path& file);  ///< A vehicle file.
VehicleParameters read_vehicle(const file::TomlNode& root);         ///< The content of one.

/// A scenario file; the path of the vehicle's file is relative to the scenario's.
Scenario read_scenario(const std::filesystem::path& file);

}  // namespace kelpie::simulator
