// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"
#include "vehicle/coefficient_monitor.hpp"

namespace kelpie {

/// Share of the nominal thrust that each thruster gives, by its named changes. Nominal is the
/// vehicle before its thrust first changed. A change without a name changes no share: with little
/// excitation the refit after such a change is far off. Updates allocate nothing.
class ThrustShares {
 public:
  ThrustShares(const MotionTerms& terms, std::size_t axes);  ///< All shares are 1.

  const std::vector<Cause>& present() const { return present_; }
  double settled(std::size_t input) const;  ///< Share before the change under inspection.

  /// A cause of this change. Of a thruster, the share of the thrust in the reference (of a dead
  /// thruster 1 and the gain in nominal thrust) becomes the share of the nominal thrust.
  Cause against_nominal(const Cause& cause, const CoefficientMonitor& monitor) const;

  /// The present shares are the settled shares, but for `changed`: causes by against_nominal(),
  /// empty without a name.
  void follow(std::span<const Cause> changed);
  /// The present shares are settled, with the change `delta` of the coefficients `theta` of the
  /// reference (terms × axes; empty: unknown).
  void settle(const MotionTerms& terms, std::span<const double> theta,
              std::span<const double> delta);

  /// For CoefficientMonitor::expect_thrust(): the nominal thrust of dead thrusters, else 0.
  /// Requires room for as many values as coefficients. Allocates nothing.
  void dead_thrust(const MotionTerms& terms, std::span<double> thrust) const;

  /// Coefficients of the nominal vehicle: `theta`, those of the reference, until thrust changes.
  std::span<const double> nominal(std::span<const double> theta) const;
  /// Terms × axes: those of the reference, but thrust is the nominal thrust times its share.
  /// Allocates.
  Eigen::MatrixXd coefficients(const MotionTerms& terms, std::span<const double> theta) const;

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  double projected(std::size_t input, const CoefficientMonitor& monitor) const;

  std::vector<Cause> present_;
  std::vector<Cause> settled_;   // before the change under inspection
  RoomyVector<double> nominal_;  // before thrust first changed; empty: it has not
  std::size_t most_;             // number of coefficients
};

}  // namespace kelpie
