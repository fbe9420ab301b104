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

namespace kelpie {

/// Result for one parameter.
enum class ParameterState : std::uint8_t {
  known,       ///< given: the inertia in the denominator of all ratios, or the source of the scale
  identified,  ///< estimated
  at_bound,    ///< the constraint on the sign is active
  not_told,    ///< not determined by the log: the value alone is meaningless
};

/// What a parameter is.
enum class ParameterKind : std::uint8_t {
  inertia,
  size,      ///< a drag, a thrust, the righting moment
  coupling,  ///< of two inertias
  offset,    ///< a force or moment that may be 0
  arm,
  angle,
  curve,  ///< of the thrust curve
};

/// Estimate of one parameter.
struct FittedParameter {
  std::string name;  ///< "sway_inertia", "th1.forward"
  double value = 0.0;
  double error = 0.0;  ///< standard error
  ParameterState state = ParameterState::identified;
  bool scales = true;  ///< proportional to the scale of forces; angles, arms and times are not
  ParameterKind kind = ParameterKind::size;
};

/// Parameters of an equation of motion, estimated from a log.
struct ParameterFit {
  std::vector<FittedParameter> parameters;  ///< ratios to the surge inertia until scaled
  Matrix covariance;                        ///< of all parameters
  double misfit = 1.0;      ///< χ² of the structure over its expectation, at least 1
  std::size_t windows = 0;  ///< number of windows in the fit
  double window_s = 0.0;    ///< length of a window

  double correlation(std::size_t a, std::size_t b) const;  ///< Of two parameters; 0 without error.
};

/// Scales masses, drags and forces so that the named thrusters have the given forward coefficients
/// ("NAME.forward"), without error; for several thrusters in the geometric mean. Throws InputError
/// on an unknown or undetermined thruster and on a coefficient <= 0.
void scale_by_thrust(ParameterFit& fit, const std::vector<std::pair<std::string, double>>& forward);

/// Scales masses, drags and forces so that the surge inertia, the first parameter, is `kilograms`,
/// with a standard error of `error`. Requires kilograms > 0.
void scale_by_inertia(ParameterFit& fit, double kilograms, double error);

/// scale_by_thrust() of a copy.
template <typename Fit>
Fit scaled_by_thrust(Fit fit, const std::vector<std::pair<std::string, double>>& forward) {
  scale_by_thrust(fit, forward);
  return fit;
}

/// scale_by_inertia() of a copy.
template <typename Fit>
Fit scaled_by_inertia(Fit fit, double kilograms, double error) {
  scale_by_inertia(fit, kilograms, error);
  return fit;
}

/// Axes of a vehicle in the plane: surge [N], sway [N], yaw [N m].
inline constexpr std::size_t kPlanarAxes = 3;

/// A number per axis: surge, sway, yaw.
using PlanarVector = std::array<double, kPlanarAxes>;

/// A fixed thruster in the plane. The force is `forward` n² ahead, and `reverse` n² astern in the
/// opposite direction.
struct PlanarThruster {
  std::string name{};
  double forward = 0.0;    ///< ≥ 0
  double reverse = 0.0;    ///< ≥ 0
  double angle_rad = 0.0;  ///< of the forward force against surge, towards positive sway
  double arm_m = 0.0;      ///< moment of 1 N forwards, N m
};

/// Fossen's equation in the plane for a vehicle with port-starboard symmetry:
///   M ν̇ + C(ν) ν + (D_l + D_q |ν|) ν = Σ_i K±_i n_i|n_i| a_i + c,
///   M = [m11 0 0; 0 m22 m23; 0 m23 m33],   C from M (Fossen 2011, theorem 3.2).
/// Division of all parameters by one inertia makes forces accelerations; m11 is then 1.
struct PlanarVehicle {
  double surge_inertia = 1.0;     ///< m11, kg: mass and added mass
  double sway_inertia = 1.0;      ///< m22, kg
  double sway_yaw_inertia = 0.0;  ///< m23, kg m
  double yaw_inertia = 1.0;       ///< m33, kg m²
  PlanarVector linear_drag{};     ///< N s/m, N s/m, N m s/rad
  PlanarVector quadratic_drag{};  ///< N s²/m², N s²/m², N m s²/rad²
  PlanarVector constant_force{};  ///< N, N, N m
  std::vector<PlanarThruster> thrusters{};

  /// ν̇ [m/s², m/s², rad/s²]. Requires m11 > 0, m22 m33 > m23², and a speed per thruster.
  PlanarVector acceleration(std::span<const double, kPlanarAxes> velocity,
                            std::span<const double> speeds) const;
};

/// Rows of a log of a vehicle in the plane: velocities through the water and thruster speeds, in
/// FLU (sway to port, yaw to port positive) or FRD. Identified parameters are in the same frame.
struct PlanarRows {
  std::vector<std::string> thrusters;
  std::vector<double> times_s;     ///< of each row, never decreasing within a stretch
  std::vector<double> velocities;  ///< rows × 3: surge, sway [m/s], yaw rate [rad/s]; finite
  std::vector<double> speeds;  ///< rows × thrusters, in any unit; thrust is proportional to n|n|
  std::vector<std::size_t> starts{0};  ///< first row of each stretch without a gap, increasing

  std::size_t rows() const { return times_s.size(); }
  /// Surge, sway and yaw rate of a row.
  std::span<const double, kPlanarAxes> velocity(std::size_t row) const {
    return std::span<const double>(velocities).subspan(kPlanarAxes * row).first<kPlanarAxes>();
  }
  /// Thruster speeds of a row.
  std::span<const double> speed(std::size_t row) const {
    return std::span<const double>(speeds).subspan(thrusters.size() * row, thrusters.size());
  }
};

/// Places of parameters: of the vehicle, then four of each thruster.
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

  /// The first parameter of a thruster.
  static constexpr std::size_t thruster(std::size_t index) {
    return thrusters + per_thruster * index;
  }
};

/// Names and kinds of the parameters of a vehicle with these thrusters, in the order of
/// PlanarPlace.
std::vector<FittedParameter> planar_parameters(const std::vector<std::string>& thrusters);
/// The names of planar_parameters().
std::vector<std::string> planar_parameter_names(const std::vector<std::string>& thrusters);

/// Parameters of Fossen's equation in the plane, estimated from a log.
struct PlanarFit : ParameterFit {
  Matrix free_terms;  ///< coefficients of the terms without the structure: terms × axes

  PlanarVehicle vehicle() const;  ///< The estimates, undetermined parameters included.
  /// Prediction with free_terms. Shapes as in PlanarVehicle.
  PlanarVector free_acceleration(std::span<const double, kPlanarAxes> velocity,
                                 std::span<const double> speeds) const;
};

/// Estimates the parameters of Fossen's equation from velocities and thruster speeds alone.
///
/// 1. Weak form (modulating functions, Shinbrot 1957): the equation times a smooth bump of 5 s,
///    integrated, with the derivative moved from the velocity to the bump. No measurement is
///    differentiated. Windows every half second, each within a stretch. Speeds between rows are
///    ramps or steps, as explains most.
/// 2. Regression of the accelerations on all terms of the equation, axis by axis, with smaller
///    weights for outlying windows (Huber 1964). Noise is assumed in the accelerations only.
/// 3. M, D, K and the directions of thrust with the least distance to these coefficients in the
///    metric of the errors (minimum distance, three-stage least squares: Zellner & Theil 1962),
///    with D, K ≥ 0 and M positive definite: a convex program, repeated as directions move.
/// 4. Standard errors: sandwich estimate with autocorrelation (Andrews 1991, Parzen kernel), times
///    the root of the misfit, plus 0.3 % of the value as the error of equations in the plane.
///
/// Requires finite numbers and rows × thrusters speeds. Throws InputError naming the undetermined
/// masses or thrusts if rows or excitation are insufficient. Cost: windows × (11 + 2 thrusters)² ×
/// lags. Allocates. Deterministic.
PlanarFit fit_planar(const PlanarRows& rows);

/// Agreement of the accelerations in a log with the slopes of its velocities, for one axis.
struct AccelerationCheck {
  double correlation = 0.0;
  double slope = 0.0;  ///< of the log's acceleration over the velocity's slope
};

/// Both smoothed over windows as in fit_planar(). `accelerations`: rows × 3. Throws InputError on
/// too few rows, as fit_planar() does.
std::array<AccelerationCheck, kPlanarAxes> check_accelerations(
    const PlanarRows& rows, std::span<const double> accelerations);

}  // namespace kelpie
