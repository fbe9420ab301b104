// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kelpie/identify/planar_fit.hpp"
#include "kelpie/motion/frame.hpp"

namespace kelpie {

/// Axes of a vehicle: surge, sway, heave [N], roll, pitch, yaw [N m].
inline constexpr std::size_t kSixAxes = 6;

/// A number per axis.
using SixVector = std::array<double, kSixAxes>;

/// A fixed thruster whose place is known, FRD about the origin of the measured velocities.
struct PlacedThruster {
  std::string name;
  Triple position_m{};
  Triple direction{1.0, 0.0, 0.0};  ///< of the force for commands above 0; unit length
};

/// What all thrusters of a vehicle make of a command c: after the delay, n follows
/// sign(c) (|c| − dead_band) / (1 − dead_band) with the lag; the thrust is K± n|n| times
/// (volts / nominal volts)^exponent.
struct ThrustCurve {
  double lag_s = 0.1;
  double delay_s = 0.0;
  double dead_band = 0.0;  ///< share of the full command
  double exponent = 0.0;
};

/// Rows of a log of six axes. FRD; velocities through the water.
struct SixAxisRows {
  std::vector<PlacedThruster> thrusters;
  std::vector<double> times_s{};       ///< of each row, never decreasing within a stretch
  std::vector<double> velocities{};    ///< rows × 6: m/s, rad/s; finite
  std::vector<double> down{};          ///< rows × 3: direction of gravity in the body
  std::vector<double> commands{};      ///< rows × thrusters: 0 at rest, ±1 in full
  std::vector<double> volts{};         ///< of the supply; empty: unknown
  double nominal_volts = 1.0;          ///< of the thrust coefficients
  std::vector<std::size_t> starts{0};  ///< first row of each stretch without a gap, increasing

  std::size_t rows() const { return times_s.size(); }
};

/// n of every row and thruster, times (volts / nominal)^(exponent / 2), so that thrusts are K±
/// n|n|. rows × thrusters. Allocates.
std::vector<double> thruster_speeds(const SixAxisRows& rows, const ThrustCurve& curve);

/// Places of parameters: of the vehicle, then two of each thruster, then those of the thrust curve.
struct SixAxisPlace {
  static constexpr std::size_t inertia = 0;         ///< and the next five: mass and added mass
  static constexpr std::size_t low_centre = 6;      ///< m z_g, couples surge to pitch, sway to roll
  static constexpr std::size_t forward_centre = 7;  ///< m x_g, couples sway to yaw, heave to pitch
  static constexpr std::size_t linear_drag = 8;     ///< and the next five
  static constexpr std::size_t quadratic_drag = 14;  ///< and the next five
  static constexpr std::size_t net_weight = 20;      ///< weight less buoyancy, N
  static constexpr std::size_t moment = 21;          ///< W r_g − B r_b, N m: and the next two
  static constexpr std::size_t thrusters = 24;       ///< forward, reverse
  static constexpr std::size_t curve_size = 4;       ///< lag, delay, dead band, exponent

  /// Of the forward coefficient of a thruster, counted from 0.
  static constexpr std::size_t thruster(std::size_t index) { return thrusters + 2 * index; }
  /// Of the thrust curve, after `count` thrusters.
  static constexpr std::size_t curve(std::size_t count) { return thrusters + 2 * count; }
};

/// Parameters of Fossen's equation on six axes, estimated from a log:
///   M ν̇ + C(ν) ν + (D_l + D_q |ν|) ν + g = Σ_i K±_i n_i|n_i| b_i,
/// M with six inertias and the two couplings of a vehicle with port-starboard symmetry, C from M
/// (Fossen 2011, theorem 3.2), g from the direction of gravity, b_i from place and direction.
struct SixAxisFit : ParameterFit {
  std::vector<PlacedThruster> thrusters;
  ThrustCurve curve;
  Matrix free_terms;  ///< coefficients of the terms without the structure: terms × axes

  /// ν̇ by the identified vehicle. Requires `speeds` as of thruster_speeds().
  SixVector acceleration(std::span<const double, kSixAxes> velocity,
                         std::span<const double, 3> down, std::span<const double> speeds) const;
  /// ν̇ by free_terms. Requirements as of acceleration().
  SixVector free_acceleration(std::span<const double, kSixAxes> velocity,
                              std::span<const double, 3> down,
                              std::span<const double> speeds) const;
};

/// Options of fit_six_axes().
struct SixAxisSettings {
  ThrustCurve start{};
  bool find_times = true;  ///< lag and delay are sought; else those of `start` hold
};

/// Estimates the parameters in the weak form, as fit_planar() does, with these differences:
/// 1. The window is the one of 0.5 to 8 s with the least errors (the sum of logarithms).
/// 2. Thrusters' places are given, so that the structure is linear in the parameters.
/// 3. The thrust curve is found by Gauss-Newton steps: derivatives of the thrust by its parameters
///    are further terms, whose coefficients are the steps.
/// 4. Errors: sandwich from 24 pieces of the log, Student's t with 23 degrees of freedom, times the
///    root of the misfit; plus what a scale of ±0.2 % and a bias of ±1 mm/s of each velocity do to
///    the fit, 1 mrad of attitude in the moments, and half a row in lag and delay.
/// A parameter whose error blurs more than 30 % of the forces on its axis is not told. Throws
/// InputError on too few rows, and naming inertias that are not told. Cost: per window length some
/// eight times windows × (36 + 2 thrusters + 24)², for errors twelve times more. Allocates.
/// Deterministic.
SixAxisFit fit_six_axes(const SixAxisRows& rows, const SixAxisSettings& options = {});

}  // namespace kelpie
