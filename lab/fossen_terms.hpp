// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

namespace kelpie::lab {

/// The terms in which Fossen's equations of motion are linear, of velocities ν and thruster speeds
/// n. For ν = (u, v, r):
///
///     u, v, r,  u|u|, v|v|, r|r|,  uv, ur, vr,  r²,  n⁺², −n⁻² for every thruster,  1
///
/// that is: linear and quadratic damping, Coriolis and added mass (products of two velocities and
/// the square of the last), thrust with its own coefficient ahead and astern, a constant.
class FossenTerms {
 public:
  static constexpr std::size_t kMostVelocities = 6;
  static constexpr int kMostTerms = 160;  ///< 6 velocities and 58 thrusters: 146

  /// The values live on the stack.
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostTerms, 1>;

  /// Requires 1 <= velocities <= kMostVelocities, velocities + thrusters <= kMostInputs.
  FossenTerms(std::size_t velocities, std::size_t thrusters)
      : velocities_(velocities), thrusters_(thrusters) {}

  std::size_t inputs() const { return velocities_ + thrusters_; }
  std::size_t size() const {
    return 2 * velocities_ + velocities_ * (velocities_ - 1) / 2 + 1 + 2 * thrusters_ + 1;
  }

  /// Requires x of inputs() values: first the velocities, then the thrusters. Allocates nothing.
  Values operator()(std::span<const double> x) const;

 private:
  std::size_t velocities_;
  std::size_t thrusters_;
};

}  // namespace kelpie::lab
