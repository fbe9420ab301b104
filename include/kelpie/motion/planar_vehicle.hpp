// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kelpie/motion/planar_rows.hpp"

namespace kelpie {

/// A fixed thruster in the plane. Forwards it pushes with `forward` n², in reverse with `reverse`
/// n² the other way.
struct PlanarThruster {
  std::string name{};
  double forward = 0.0;    ///< ≥ 0
  double reverse = 0.0;    ///< ≥ 0
  double angle_rad = 0.0;  ///< of the forward force against surge, towards positive sway
  double arm_m = 0.0;      ///< moment of 1 N forwards, N m
};

/// Fossen's equation in the plane for a vehicle that is alike on port and starboard:
///   M ν̇ + C(ν) ν + (D_l + D_q |ν|) ν = Σ_i K±_i n_i|n_i| a_i + c,   M = [m11 0 0; 0 m22 m23; 0 m23
///   m33]
/// with C from M (Fossen 2011, theorem 3.2). All may be divided by the same inertia: then forces
/// are accelerations, and m11 is 1.
struct PlanarVehicle {
  double surge_inertia = 1.0;     ///< m11, kg: mass and added mass
  double sway_inertia = 1.0;      ///< m22, kg
  double sway_yaw_inertia = 0.0;  ///< m23, kg m
  double yaw_inertia = 1.0;       ///< m33, kg m²
  PlanarVector linear_drag{};     ///< N s/m, N s/m, N m s/rad
  PlanarVector quadratic_drag{};  ///< N s²/m², N s²/m², N m s²/rad²
  PlanarVector constant_force{};  ///< N, N, N m
  std::vector<PlanarThruster> thrusters{};

  /// ν̇ [m/s², m/s², rad/s²]. Requires m11 > 0, m22 m33 > m23², as many speeds as thrusters.
  PlanarVector acceleration(std::span<const double, kPlanarAxes> velocity,
                            std::span<const double> speeds) const;
};

}  // namespace kelpie
