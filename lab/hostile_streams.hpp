// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::lab {

inline constexpr Eigen::Index kHostileSamples = 4000;

/// A simulated stream of kHostileSamples samples at 5 Hz, hard to learn. In all arrays: a row per
/// input or target, a column per sample.
struct HostileStream {
  std::vector<std::string> inputs{"u", "v", "r", "th1", "th2", "th3"};
  std::vector<std::string> targets{"udot", "vdot", "rdot"};
  std::size_t velocities = 3;  ///< number of first inputs with products in the yardsticks' terms
  Eigen::ArrayXd times_s;
  Eigen::ArrayXXd x;      ///< inputs, as received
  Eigen::ArrayXXd y;      ///< targets, as received
  Eigen::ArrayXXd truth;  ///< targets without noise and faults
  /// Samples without the vehicle's inputs, from which no learner can predict the truth.
  std::vector<bool> hidden = std::vector<bool>(kHostileSamples);
};

/// A kind of hostile streams.
struct HostileKind {
  std::string name;
  std::string meaning;
  std::function<HostileStream(RandomStream&)> make;

  /// The stream of a seed: equal on every call. Cost: some milliseconds.
  HostileStream stream(std::uint64_t seed) const;
};

/// All kinds. The same vehicle drives in all streams with the inputs u, v, r, th1, th2, th3: surge,
/// sway and yaw with linear and quadratic drag, coupled, under three saturating thrusters with a
/// new goal every 5 s. Noise in standard deviations of the signal: 0.01 on velocities, 0.05 on
/// targets.
std::vector<HostileKind> hostile_kinds();

}  // namespace kelpie::lab
