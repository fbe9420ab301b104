// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <string>

#include "kelpie/core/random.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// How the thrusters are driven.
enum class ExcitationMode {
  independent,  ///< in the plane: a sinusoid per lateral thruster
  correlated,   ///< in the plane: surge thrusters with the given correlation
  prbs,         ///< Pilot: wishes of −1 or 1
  steps,        ///< Pilot: wishes between −1 and 1
  pilot,        ///< Pilot: steps, approached as by a hand on a stick
};

ExcitationMode excitation_mode_from(const std::string& name);  ///< Throws InputError.

/// Commands of the thrusters.
struct ExcitationSettings {
  ExcitationMode mode = ExcitationMode::independent;
  double shortest_period_s = 20.0;  ///< of a cycle, or between two wishes
  double longest_period_s = 70.0;
  double correlation = 0.78;  ///< of the surge thrusters' commands, in [-1, 1]; mode correlated
  Vector6 effort = Vector6::Zero();  ///< of a wish of 1 on each axis, N and N m; modes of Pilot
  double dither = 0.0;  ///< of each command by itself, share of the greatest; modes of Pilot

  /// Whether the three lateral thrusters are driven, and the vertical thrusters hold the vehicle.
  bool in_plane() const {
    return mode == ExcitationMode::independent || mode == ExcitationMode::correlated;
  }
  /// Throws InputError whose field is the key in a scenario file ("excitation.period_s").
  void validate() const;
};

/// A sine with a random period per cycle, advanced on a fixed time grid: the draws don't depend on
/// the integrator.
class Oscillator {
 public:
  /// Requires settings that validate.
  Oscillator(const ExcitationSettings& settings, RandomStream stream);

  double advance(double dt_s);                   ///< value after dt_s, in [-1, 1]
  double period_s() const { return period_s_; }  ///< of the current cycle

 private:
  double shortest_s_, longest_s_;
  RandomStream stream_;
  double period_s_;
  double cycle_share_ = 0.0;  ///< finished share of the cycle, in [0, 1)
};

/// Commands of the three lateral thrusters (surge left, surge right, sway).
class Excitation {
 public:
  /// Requires settings that validate; greatest speeds in rev/s.
  Excitation(const ExcitationSettings& settings, const Eigen::Vector3d& max_speeds_rps,
             std::uint64_t seed);

  /// Commands after `dt_s`, at `amplitude` times the greatest speeds, rev/s.
  Eigen::Vector3d advance(double dt_s, double amplitude);

 private:
  std::array<Oscillator, 3> oscillators_;
  Eigen::Matrix3d mixing_;  ///< greatest speeds included
};

}  // namespace kelpie::simulator
