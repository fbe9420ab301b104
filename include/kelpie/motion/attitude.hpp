// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie {

/// The inputs with the orientation of the vehicle. Forces by gravity and buoyancy depend on roll
/// and pitch alone (Fossen 2011, eq. 4.6), and no force depends on the heading.
struct Attitude {
  std::optional<std::size_t> roll{};
  std::optional<std::size_t> pitch{};
  std::optional<std::array<std::size_t, 4>> quaternion{};  ///< x, y, z, w
  std::vector<std::size_t> headings{};
  double roll_unit = 1.0;   ///< of the input [rad]
  double pitch_unit = 1.0;  ///< of the input [rad]

  /// Whether an input is one of these.
  bool contains(std::size_t input) const;
};

/// The attitude by names, in any case: roll, pitch, yaw; phi, theta, psi; heading, course, also
/// with an ending such as _angle, _rad or _deg, and as fields of a message (attitude.roll);
/// quaternions as qx, qy, qz, qw; q_x, …; quat_x, …; orientation.x, …. Fields of commands, rates
/// and velocities (cmd.roll) are no angles of the vehicle. Angles are in degrees by the ending
/// _deg, or all of them with `degrees`.
Attitude find_attitude(std::span<const std::string> inputs, bool degrees = false);

/// The attitude under the setting `terms` (TermSet::from): in degrees with `auto:degrees`, none
/// with `quadratic`, which takes angles as any other input.
Attitude attitude_for(std::string_view terms, std::span<const std::string> inputs);

/// The part of an attitude that follows from the angular velocities of a model (Fossen 2011,
/// eq. 2.27 and 2.66), for integration in open loop: roll from p, pitch from q, a quaternion from
/// p, q and r, angular velocities in rad/s. Angles without such a velocity are given, as commands.
class AttitudeMotion {
 public:
  AttitudeMotion() = default;  ///< nothing to integrate
  /// `states`: the inputs that the model integrates.
  AttitudeMotion(const Attitude& attitude, std::span<const std::string> inputs,
                 std::span<const std::size_t> states);

  static constexpr std::size_t kMostInputs = 4;
  /// The inputs to integrate: at most kMostInputs.
  const std::vector<std::size_t>& inputs() const { return inputs_; }
  /// Whether an input is an angular velocity that moves the attitude.
  bool follows(std::size_t input) const {
    return std::ranges::find(turning_, std::optional(input)) != turning_.end();
  }
  /// Their derivatives at the inputs x, in the units of the inputs per second. Allocates nothing.
  void rates(std::span<const double> x, std::span<double> rates) const;

 private:
  Attitude attitude_;
  std::array<std::optional<std::size_t>, 3> turning_{};  ///< p, q, r among the inputs
  std::vector<std::size_t> inputs_;
};

/// Unit of the angles of an attitude by their largest sizes.
enum class AngleUnit : std::uint8_t {
  radians,
  degrees,
  none,  ///< beyond a turn in degrees: no angles
};

/// `largest`: of every input. Radians as long as pitch stays within ±π/2 and roll within ±2π.
AngleUnit unit_of_angles(const Attitude& attitude, std::span<const double> largest);

}  // namespace kelpie
