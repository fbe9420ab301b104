// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

namespace kelpie {

/// The components of a vector along x, y and z of its frame.
using Triple = std::array<double, 3>;

/// Right-handed frames. Vehicle: FLU (x forward, y left, z up), FRD (forward, right, down). World:
/// ENU (east, north, up), NED (north, east, down).
enum class Frame { flu, frd, enu, ned };

/// Throws InputError naming the four frames.
Frame frame_from(const std::string& name);

/// "FLU".
std::string frame_name(Frame frame);

/// Converts a vector between two vehicle frames or two world frames: velocities, accelerations,
/// forces, and rates, because the conversions are rotations. Its own inverse.
/// Throws InputError for a vehicle frame and a world frame, whose relation is the attitude.
Triple converted(const Triple& vector, Frame from, Frame to);

/// Rotates a world vector to the vehicle's axes: NED to FRD, ENU to FLU. `angles`: roll, pitch and
/// yaw [rad], applied in the order yaw, pitch, roll.
Triple in_body(const Triple& vector, const Triple& angles);
/// The same rotation from a quaternion w, x, y, z of any length above 0; otherwise NaN.
Triple in_body(const Triple& vector, const std::array<double, 4>& quaternion);

/// The velocity of the body's origin from the velocity of a sensor at `arm_m`: v − ω × r.
/// All in one body frame: [m/s], [rad/s], [m].
Triple without_lever_arm(const Triple& velocity, const Triple& rates, const Triple& arm_m);

}  // namespace kelpie
