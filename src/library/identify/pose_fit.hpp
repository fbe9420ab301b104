// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kelpie/identify/planar_fit.hpp"

namespace kelpie {

/// Rows of a log of a vehicle in the plane whose poses are measured. The axes of world and body are
/// of one kind: v goes a quarter turn from u, as y goes from x, and headings grow that way.
struct PoseRows {
  std::vector<std::string> thrusters;
  std::vector<double> times_s;         ///< of each row, increasing within a stretch
  std::vector<double> poses;           ///< rows × 3: x, y [m], continuous heading [rad]; or NaN
  std::vector<double> speeds;          ///< rows × thrusters; thrust is proportional to n|n|
  std::vector<std::size_t> starts{0};  ///< first row of each stretch without a gap, increasing
};

/// Estimates the parameters of Fossen's equation from poses and thruster speeds, without a
/// velocity.
///
/// 1. Output errors (Maine & Iliff 1986): the vehicle is simulated from the thruster speeds, and
///    the simulated poses are compared with the measured ones. Velocities come from the simulation,
///    so noise of the poses enters no regressor.
/// 2. Multiple shooting (Bock 1983): pieces of some two minutes have a start of their own each, and
///    are not tied to each other. Starts are eliminated from the normal equations of each step.
/// 3. Levenberg-Marquardt steps with bounds (D, K ≥ 0), Huber's weights by the robust deviation of
///    the residuals. Derivatives are integrated along.
/// 4. The first estimate: yaw alone from the headings, where moments of the thrusters are linear
///    and several time constants are tried; then surge and sway from the positions, likewise; then
///    all, in pieces of 20 s, quadratic drag last. Speeds between rows are ramps or steps, as
///    explains most.
/// 5. Standard errors: inverse of the normal equations, with the variance of x and y, and of the
///    heading, times the sum of the residuals' autocorrelations; plus 0.3 % of the value, as
///    fit_planar(), and the effect of 0.3 % of m22 in the Munk moment (m11 − m22) u v, which alone
///    tells m33.
///
/// A constant current, and a shift of the speeds in time where ramps explain most, are estimated
/// along and are not among the parameters. PlanarFit::windows counts the pieces, `misfit` is the
/// largest sum of autocorrelations, free_terms are empty.
///
/// Throws InputError naming the undetermined masses or thrusts if rows or excitation are
/// insufficient. Cost: some 100 simulations of the rows with derivatives. Allocates. Deterministic.
PlanarFit fit_poses(const PoseRows& rows);

}  // namespace kelpie
