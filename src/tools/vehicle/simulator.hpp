// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "vehicle/dynamics.hpp"
#include "vehicle/hold.hpp"
#include "vehicle/integrator.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// The fixed time grid of commands, control and integration.
inline constexpr std::int64_t kTicksPerSecond = 100;
inline constexpr double kTickS = 1.0 / static_cast<double>(kTicksPerSecond);

/// Number of ticks in a duration; 0 unless positive and whole.
std::int64_t ticks_in(double duration_s);

/// A vehicle under way, advanced tick by tick: hold, rotors, Runge-Kutta.
class Simulator {
 public:
  /// At time 0, in a uniform current.
  Simulator(const VehicleParameters& vehicle, const Plant& plant,
            const Eigen::Vector3d& current_m_s, const State& start);

  /// Replaces the coefficients of the vehicle.
  void set_plant(const Plant& plant);

  /// One tick with commands to surge left, surge right and sway, rev/s. Throws InputError with
  /// time and state on a state that isn't finite: the vehicle's numbers don't fit together. Doesn't
  /// allocate otherwise.
  void advance(const Eigen::Vector3d& lateral_rps);

  const State& state() const { return state_; }
  /// Acceleration in the body frame (FRD) at this instant.
  Vector6 acceleration() const;
  double time_s() const { return static_cast<double>(ticks_) / kTicksPerSecond; }

 private:
  Eigen::Vector3d current_;
  Dynamics dynamics_;
  DepthPitchHold hold_;
  RotorDrive drive_;
  State state_;
  std::int64_t ticks_ = 0;
};

/// Free run on a log: surge, sway and yaw rate (FLU) at every row, from a level start with the
/// velocities `start` (FLU) and with the measured speeds of the lateral rotors, linear between
/// rows. No rotor lag: measured speeds include the lag. Throws InputError unless `period_s` is a
/// whole number of ticks.
std::vector<Eigen::Vector3d> free_run(const VehicleParameters& vehicle,
                                      const Eigen::Vector3d& start,
                                      std::span<const Eigen::Vector3d> rotors_rps, double period_s);

}  // namespace kelpie::vehicle
