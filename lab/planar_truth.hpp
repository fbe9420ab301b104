// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulator/scenario.hpp"

namespace kelpie::lab {

/// The parameters of a scenario's vehicle in its first configuration, in the order of PlanarPlace
/// for the thrusters th1, th2, th3, FLU. Requires a vehicle that drives_in_plane().
std::vector<double> planar_truth(const simulator::Scenario& scenario);

}  // namespace kelpie::lab
