// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kelpie {

struct AlignmentProblem;

/// The ocean current of a log: a horizontal velocity of the water over ground, irrotational, the
/// same wherever the vehicle was, constant or slowly wandering in time. The equations of motion
/// hold for velocities through the water (Fossen 2011, eq. 8.2 to 8.6, for a vehicle that is
/// level):
///
///     u_r = u − c₁ cos ψ − c₂ sin ψ         u̇_r = u̇ − r (c₂ cos ψ − c₁ sin ψ)
///     v_r = v + c₁ sin ψ − c₂ cos ψ         v̇_r = v̇ + r (c₁ cos ψ + c₂ sin ψ)
///
/// ψ turns with the yaw rate r; c₁ goes along the heading 0, c₂ along a quarter turn. The default
/// is still water.
struct Current {
  std::string heading{};  ///< column of the log
  double unit = 1.0;      ///< of the heading [rad]; below 0: the heading falls while r > 0
  std::string surge{}, sway{}, yaw_rate{};        ///< inputs u, v [m/s], r [rad/s]
  std::array<std::size_t, 2> targets{0, 1};       ///< places of u̇, v̇ [m/s²]
  std::vector<double> times_s{};                  ///< ascending, of the log
  std::vector<std::array<double, 2>> velocity{};  ///< c₁, c₂ at these times [m/s]

  bool operator==(const Current&) const = default;

  bool none() const { return times_s.empty(); }

  /// c₁, c₂ at the time `t` of the log: in straight lines between the times, and constant before
  /// the first and after the last time. Requires a current. Allocates nothing.
  std::array<double, 2> at(double t) const;

  /// c in the body's surge and sway [m/s] at a reading of the heading in the log's unit. Requires a
  /// current. Allocates nothing.
  std::array<double, 2> in_body(double reading, double t) const;

  /// The least and the largest speed at the times [m/s]. Requires a current.
  std::array<double, 2> speeds() const;

  /// "a current of 0.1 to 0.4 m/s, on average 0.22 m/s towards 345° of psi".
  std::string text() const;

  /// Throws InputError (field) on times that do not ascend, a number that is not finite, a unit of
  /// 0, and on another number of velocities than times.
  void validate() const;
};

/// The result of a search, with the reason.
struct CurrentResult {
  Current current;    ///< still water without evidence
  double gain = 0.0;  ///< share of the variance unexplained in still water
  std::string why;    ///< in words
};

/// Estimates the current that the accelerations of a log tell. `headings`: of the column `name`,
/// for every row of the log. Requires commands that are aligned already, and no heading among the
/// inputs. The unit and the sense of the heading follow from the turns of the vehicle.
///
/// Accelerations are fitted by least squares on velocities through the water and commands
/// (MotionTerms::alignment); the current at some times, with straight lines in between, follows by
/// variable projection (Golub & Pereyra 1973; Kaufman 1975). From still water over a constant
/// current to one that is told at up to 33 times, the simplest within one standard error of the
/// best on folds (Breiman et al. 1984) is taken, and kept on clear evidence only, as in
/// find_alignment(). Otherwise the water is still, with the reason. Cost: some 60 fits to at most
/// 3,000 rows.
CurrentResult find_current(const AlignmentProblem& problem, const std::string& name,
                           std::span<const double> headings);

}  // namespace kelpie
