// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "kelpie/motion/planar_rows.hpp"

namespace kelpie {

/// Terms of the equation, in this order; then n² forwards and −n² in reverse of each thruster.
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

/// The terms of one row, into `terms` of that size.
void planar_terms(std::span<const double, kPlanarAxes> velocity, std::span<const double> speeds,
                  Eigen::Ref<Eigen::VectorXd> terms);

/// Rows in the weak form: one per window.
struct WeakRows {
  Eigen::MatrixXd acceleration;  ///< windows × 3, from velocities
  Eigen::MatrixXd terms;         ///< windows × terms
  Eigen::MatrixXd given;         ///< windows × 3, of the accelerations that were given, if any
};

inline constexpr double kHalfWindowS = 2.5;

/// Windows every half second within stretches. `accelerations` (rows × 3) may be empty. Windows
/// with a value far beyond all others (a spike in the log) are left out.
WeakRows weak_rows(const PlanarRows& rows, std::span<const double> accelerations);

}  // namespace kelpie
