// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <string>
#include <vector>

#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// Names of frame_thrusters(): ArduSub's frames.
std::vector<std::string> frame_names();

/// Names, places and directions of the motors m1, m2, … of an ArduSub frame, for a vehicle of the
/// size length, width, height. Directions are ArduSub's (AP_Motors6DOF.cpp): the push of a pulse
/// above 1500 µs. Places are a BlueROV2's, stretched to the size; ArduSub knows none. Thrusts are
/// 0. Throws InputError on an unknown name.
std::vector<Thruster> frame_thrusters(const std::string& frame, const Eigen::Vector3d& size_m);

/// How far the thrusters drive an axis.
enum class AxisDrive {
  none,      ///< no thruster pushes along the axis
  together,  ///< every push along the axis pushes another axis as well
  alone,     ///< some set of thrusts pushes along the axis only
};

/// In the order of Vector6. Thrusts forwards and in reverse count alike.
std::array<AxisDrive, 6> driven_axes(const std::vector<Thruster>& thrusters);

/// Number of independent wrenches, 0 to 6.
int wrench_rank(const std::vector<Thruster>& thrusters);

/// Body, water, actuators and hold by similarity with the BlueROV2 Heavy of von Benzon et al. 2022
/// (vehicles/bluerov2_heavy.toml), for a vehicle of this mass and size: masses by mass, inertias by
/// mass and squared lengths, drag by areas and lengths. Without thrusters and battery. Requires a
/// positive mass and size.
VehicleParameters similar_vehicle(double mass_kg, const Eigen::Vector3d& size_m);

}  // namespace kelpie::simulator
