// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "identify/weak_form.hpp"
#include "kelpie/identify/planar_fit.hpp"

namespace kelpie {

/// x, y [m] and heading [rad] in the world, surge, sway and yaw rate through the water.
using PoseState = Eigen::Matrix<double, 6, 1>;

/// Derivatives of a PoseState by some parameters and by the state at the start: a column each.
using StateSlopes = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Places of the parameters of a path: PlanarPlace with m11 = 1, where a thruster has its forward
/// force along surge in the place of `forward`, along sway in that of `angle`, the moment in that
/// of `arm`, and the ratio of the reverse force in that of `reverse`. Then come an error of the
/// Munk moment, as a share ε of m22 in (m11 − (1 + ε) m22) u v, which is 0; a shift of the thruster
/// speeds [s], taken so much later; and the current in x and y [m/s].
/// A thruster's forces are linear there, so a first estimate needs no direction. Moments (of drag
/// and thrusters, and the constant one) are divided by m33, and the place of m22 has
/// (m22 − m11) / m33: headings tell these ratios well whatever m33 is, and positions tell m33 by
/// way of m22.
struct PathPlace {
  static constexpr Eigen::Index surge = 0, ratio = 1, sway = 2, moment = 3;  ///< of a thruster

  static Eigen::Index thruster(Eigen::Index index) {
    return static_cast<Eigen::Index>(PlanarPlace::thruster(static_cast<std::size_t>(index)));
  }
  static Eigen::Index munk(Eigen::Index thrusters) { return thruster(thrusters); }
  static Eigen::Index shift(Eigen::Index thrusters) { return munk(thrusters) + 1; }
  static Eigen::Index current(Eigen::Index thrusters) { return munk(thrusters) + 2; }
  static Eigen::Index count(Eigen::Index thrusters) { return current(thrusters) + 2; }
};

/// Rows without a gap that one start leads through.
struct PathPiece {
  Eigen::VectorXd times_s;
  Eigen::Matrix3Xd poses;  ///< x, y, heading, which is continuous; NaN: not measured
  Eigen::MatrixXd speeds;  ///< thrusters × rows
};

/// States at the rows of a piece, and the derivatives of their poses.
struct PathStates {
  Eigen::Matrix<double, 6, Eigen::Dynamic> states;
  /// 3 rows × (sought + 6): by the parameters sought, then by the start. Empty where not wanted.
  Eigen::MatrixXd jacobian;
};

/// Drives the vehicle of PlanarVehicle through a piece, from `start`, in a constant current:
///   ẋ = u cos ψ − v sin ψ + c_x,   ẏ = u sin ψ + v cos ψ + c_y,   ψ̇ = r,
///   M ν̇ = τ(n) + c − C(ν) ν − (D_l + D_q |ν|) ν          (Fossen 2011, eq. 6.1 and 8.3)
/// by Runge-Kutta's method of order four, and the variational equations along with the state
/// (Bock 1983). Only ramps are shifted. Velocities are through the water, in which C and D act.
/// `sought`: places of PathPlace. A path that leaves all bounds has states that are not finite.
/// Allocates.
PathStates drive_piece(const PathPiece& piece, const Eigen::VectorXd& parameters,
                       const PoseState& start, BetweenRows between,
                       const std::vector<Eigen::Index>& sought, bool with_jacobian);

/// ν̇ of a state.
Eigen::Vector3d path_acceleration(const Eigen::VectorXd& parameters, const PoseState& state,
                                  const Eigen::VectorXd& speeds);

}  // namespace kelpie
