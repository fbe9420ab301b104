// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace kelpie {

/// A vector's three components: along x, y and z of its frame.
using Triple = std::array<double, 3>;

/// Right-handed frames by name: of the vehicle FLU (x forward, y left, z up) and FRD (forward,
/// right, down), of the world ENU (east, north, up) and NED (north, east, down).
enum class Frame { flu, frd, enu, ned };

/// Throws InputError naming the four.
Frame frame_from(const std::string& name);

/// The same vector in another frame of the same kind: velocities, accelerations, forces and, since
/// these are turns, rates too. Its own inverse.
/// Throws InputError for a frame of the vehicle and one of the world: between them lies the
/// attitude.
Triple converted(const Triple& vector, Frame from, Frame to);

/// A vector of the world along the vehicle's axes, by its attitude in that world: NED to FRD, ENU
/// to FLU. Roll, pitch and yaw [rad], turned by in the order yaw, pitch, roll.
Triple in_body(const Triple& vector, const Triple& angles);
/// The same by a quaternion w, x, y, z of any length above 0, else NaN.
Triple in_body(const Triple& vector, const std::array<double, 4>& quaternion);

/// The velocity of the body's origin, from what a sensor at `arm_m` measures: v − ω × r.
/// All in one body frame: [m/s], [rad/s], [m].
Triple without_lever_arm(const Triple& velocity, const Triple& rates, const Triple& arm_m);

}  // namespace kelpie
