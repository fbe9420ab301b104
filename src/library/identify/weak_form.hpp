// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "identify/tuning.hpp"
#include "kelpie/identify/planar_fit.hpp"
#include "motion/motion_terms.hpp"

namespace kelpie {

/// Places of the terms of MotionTerms::planar(); n² ahead and −n² astern of every thruster follow.
enum PlanarTerm : Eigen::Index {
  kTermLinear = 0,     ///< u, v, r
  kTermQuadratic = 3,  ///< u|u|, v|v|, r|r|
  kTermVr = 6,
  kTermUr,
  kTermRr,
  kTermUv,
  kTermOne,
  kTermThrusters
};

inline Eigen::Index term_count(std::size_t thrusters) {
  return kTermThrusters + 2 * static_cast<Eigen::Index>(thrusters);
}

/// MotionTerms::planar() at velocities and thruster speeds.
class PlanarTerms {
 public:
  explicit PlanarTerms(std::size_t thrusters)
      : terms_(MotionTerms::planar(thrusters)), inputs_(kPlanarAxes + thrusters) {}

  /// Requires `terms` of term_count(). Allocates nothing.
  void evaluate(std::span<const double, kPlanarAxes> velocity, std::span<const double> speeds,
                Eigen::Ref<Eigen::VectorXd> terms);

 private:
  MotionTerms terms_;
  std::vector<double> inputs_;
};

/// Test functions: bumps (1 − s²)³ of ±half_s around centres stride_s apart.
struct WindowShape {
  double half_s = 0.0;
  double stride_s = 0.0;
};

/// The windows of fit_planar(): 5 s every half second.
inline constexpr WindowShape kPlanarWindow{.half_s = kIdentification.half_window_s,
                                           .stride_s = kIdentification.stride_s};

/// Rows of an equation of motion that is linear in its terms.
struct EquationRows {
  std::span<const double> times_s;
  std::span<const std::size_t> starts;  ///< first row of each stretch without a gap
  Eigen::MatrixXd velocities;           ///< rows × axes
  Eigen::MatrixXd terms;                ///< rows × terms
  Eigen::MatrixXd given{};              ///< rows × axes: given accelerations; may be empty
};

/// The equation in the weak form: a row per window.
struct WeakRows {
  Eigen::MatrixXd acceleration;  ///< windows × axes, from velocities
  Eigen::MatrixXd terms;         ///< windows × terms
  Eigen::MatrixXd given;         ///< windows × axes, from given accelerations, if any
};

/// Windows within stretches. Windows with a spike of the log are dropped.
WeakRows weak_rows(const EquationRows& rows, const WindowShape& shape);

/// Thruster speeds between two rows. A step that is integrated as a ramp comes half a row too early
/// or too late.
enum class BetweenRows : std::uint8_t {
  ramps,        ///< in a straight line from row to row
  steps_after,  ///< the speed of a row holds until the next
  steps_before  ///< the speed of a row has held since the row before
};

/// kPlanarWindow in the plane. `accelerations` (rows × 3) may be empty.
WeakRows weak_rows(const PlanarRows& rows, std::span<const double> accelerations,
                   BetweenRows between = BetweenRows::ramps);

}  // namespace kelpie
