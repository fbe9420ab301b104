// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kelpie/core/random.hpp"
#include "simulator/excitation.hpp"
#include "simulator/hold.hpp"
#include "simulator/integrator.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// A level that changes at random moments: the next change is drawn between the shortest and the
/// longest period. Advanced on a fixed time grid: the draws don't depend on the integrator.
class RandomSteps {
 public:
  /// `binary`: levels of −1 and 1, else any between. Requires settings that validate.
  RandomSteps(const ExcitationSettings& settings, bool binary, RandomStream stream);

  double advance(double dt_s);  ///< Level after dt_s, in [-1, 1].

 private:
  double draw_level();

  double shortest_s_, longest_s_;
  bool binary_;
  RandomStream stream_;
  double level_;
  double left_s_;
};

/// Drives a vehicle with any thrusters on all axes: random wishes for a wrench, a hold of depth,
/// roll and pitch (gains of the vehicle file), the thrusts of least norm with this wrench, and the
/// commands for the thrusts at nominal voltage. An axis that the thrusters cannot push is left out
/// by the least norm. The pilot knows nothing of faults, of the battery and of the rotors' lag.
class Pilot {
 public:
  /// Requires a vehicle and settings that validate, with a mode that is not in the plane.
  Pilot(const VehicleParameters& vehicle, const ExcitationSettings& settings, std::uint64_t seed);

  /// Commands for the next `dt_s`, wishes and dither at `amplitude`. Doesn't allocate.
  RotorSpeeds advance(const State& state, double dt_s, double amplitude);

 private:
  std::vector<Thruster> thrusters_;
  CommandUnit unit_;
  Vector6 effort_;
  double dither_;
  double stick_lag_s_;  ///< 0: none
  std::vector<RandomSteps> wishes_;
  std::vector<RandomSteps> dithers_;
  Vector6 stick_ = Vector6::Zero();
  LevelHold hold_;
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMostThrusters, 6> thrusts_from_wrench_;
};

}  // namespace kelpie::simulator
