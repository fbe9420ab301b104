// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/matrix.hpp"
#include "kelpie/motion/planar_rows.hpp"
#include "kelpie/motion/planar_vehicle.hpp"

namespace kelpie {

/// What is known of a parameter.
enum class ParameterState : std::uint8_t {
  known,  ///< given: the inertia that the others are ratios of, or what gave the scale
  identified,
  at_bound,  ///< its sign is a constraint, and the data press against it
  not_told,  ///< the log doesn't tell it: the value is of no use by itself
};

/// A parameter as estimated.
struct PlanarParameter {
  std::string name;  ///< "sway_inertia", "th1.forward"
  double value = 0.0;
  double error = 0.0;  ///< standard error
  ParameterState state = ParameterState::identified;
};

/// Places of parameters: the vehicle's own first, then four of each thruster.
struct PlanarPlace {
  static constexpr std::size_t surge_inertia = 0;
  static constexpr std::size_t sway_inertia = 1;
  static constexpr std::size_t sway_yaw_inertia = 2;
  static constexpr std::size_t yaw_inertia = 3;
  static constexpr std::size_t linear_drag = 4;      ///< and the next two
  static constexpr std::size_t quadratic_drag = 7;   ///< and the next two
  static constexpr std::size_t constant_force = 10;  ///< and the next two
  static constexpr std::size_t thrusters = 13;
  static constexpr std::size_t per_thruster = 4;  ///< forward, reverse, angle, arm

  /// Of a thruster's first parameter.
  static constexpr std::size_t thruster(std::size_t index) {
    return thrusters + per_thruster * index;
  }
};

/// What a log tells of Fossen's equation in the plane.
struct PlanarFit {
  std::vector<PlanarParameter> parameters;  ///< ratios to the surge inertia until scaled
  Matrix covariance;                        ///< of all parameters
  double misfit = 1.0;  ///< how much worse than chance the structure fits (1: no worse), in χ²
  std::size_t windows = 0;  ///< that were weighed
  double window_s = 0.0;    ///< how long one is
  Matrix free_terms;        ///< coefficients of the same terms without the structure: terms × axes

  PlanarVehicle vehicle() const;  ///< The estimates, those that aren't told included.
  double correlation(std::size_t a, std::size_t b) const;  ///< Of two; 0 where one has no error.
  /// What the same terms predict without the structure that ties them. Shapes as in PlanarVehicle.
  PlanarVector free_acceleration(std::span<const double, kPlanarAxes> velocity,
                                 std::span<const double> speeds) const;
};

/// Estimates the parameters of Fossen's equation from velocities and thruster speeds alone.
///
/// 1. Weak form (modulating functions, Shinbrot 1957): the equation times a smooth bump of 5 s,
///    integrated, with the derivative moved from the velocity to the bump. No derivative of a
///    measurement is taken. Windows every half second, each within a stretch.
/// 2. Accelerations regressed on all terms of the equation, each axis by itself; windows far off
///    count less (Huber 1964). The velocities' noise is the error of this side alone.
/// 3. M, D, K and the directions are what fits these coefficients best in the metric of their
/// errors
///    (minimum distance, three-stage least squares: Zellner & Theil 1962), with D, K ≥ 0 and M
///    positive definite: a convex program, solved again as directions move.
/// 4. Standard errors: sandwich with autocorrelation (Andrews 1991, Parzen kernel), times the root
/// of
///    the misfit, and 0.3 % of the value for what an equation in the plane leaves out.
///
/// Requires finite numbers, speeds as many as rows × thrusters. Throws InputError where rows or
/// their excitation are too few for masses or thrusts, saying which. Cost: windows × (11 + 2
/// thrusters)² × lags. Allocates. The same rows give the same result.
PlanarFit fit_planar(const PlanarRows& rows);

/// Multiplies masses, drags and forces so that these thrusters have the given forward coefficients
/// (of several the geometric mean), all known exactly. Throws InputError on one that isn't told or
/// no thruster, or a coefficient that isn't > 0.
PlanarFit scaled_by_thrust(const PlanarFit& fit,
                           const std::vector<std::pair<std::string, double>>& forward);

/// The same so that the surge inertia is `kilograms`, known to a standard error of `error`.
/// Requires kilograms > 0.
PlanarFit scaled_by_inertia(const PlanarFit& fit, double kilograms, double error);

/// How the accelerations of each axis that a log has go with the slopes of its velocities.
struct AccelerationCheck {
  double correlation = 0.0;
  double slope = 0.0;  ///< of the log's against the velocity's own
};

/// Both smoothed over windows as in fit_planar(). `accelerations`: rows × 3.
std::array<AccelerationCheck, kPlanarAxes> check_accelerations(
    const PlanarRows& rows, std::span<const double> accelerations);

}  // namespace kelpie
