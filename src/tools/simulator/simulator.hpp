// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "simulator/battery.hpp"
#include "simulator/dynamics.hpp"
#include "simulator/hold.hpp"
#include "simulator/integrator.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// The fixed time grid of commands, control and integration.
inline constexpr std::int64_t kTicksPerSecond = 100;
inline constexpr double kTickS = 1.0 / static_cast<double>(kTicksPerSecond);

/// Number of ticks in a duration; 0 unless positive and whole.
std::int64_t ticks_in(double duration_s);

/// A vehicle under way, advanced tick by tick: commands, battery, rotors, Runge-Kutta. The
/// battery's voltage is constant within a tick.
class Simulator {
 public:
  /// At time 0, in a uniform current.
  Simulator(const VehicleParameters& vehicle, const Plant& plant,
            const Eigen::Vector3d& current_m_s, const State& start);

  /// Replaces the coefficients of the vehicle.
  void set_plant(const Plant& plant);

  /// One tick with a command per thruster, from −max_speed_rps to max_speed_rps. Throws InputError
  /// with time and state on a state that isn't finite: the vehicle's numbers don't fit together.
  /// Doesn't allocate otherwise.
  void advance(const RotorSpeeds& commands);

  /// One tick with commands to surge left, surge right and sway, rev/s, while the vertical
  /// thrusters hold depth and pitch. Requires drives_in_plane(). Throws as above.
  void advance_in_plane(const Eigen::Vector3d& lateral_rps);

  const State& state() const { return state_; }
  const RotorSpeeds& commands() const { return commands_; }  ///< of the last tick
  double voltage_v() const { return battery_.voltage_v(); }  ///< 0 without a battery
  /// Acceleration in the body frame (FRD) at this instant.
  Vector6 acceleration() const;
  double time_s() const { return static_cast<double>(ticks_) / kTicksPerSecond; }

 private:
  RotorSpeeds delayed(const RotorSpeeds& commands);

  VehicleParameters vehicle_;
  Eigen::Vector3d current_;
  Dynamics dynamics_;
  std::optional<DepthPitchHold> hold_;  ///< of a vehicle that is driven in the plane
  Battery battery_;
  RotorDrive drive_;
  State state_;
  RotorSpeeds commands_;
  std::vector<RotorSpeeds> waiting_;  ///< commands under way, a ring; empty: no delay
  std::int64_t ticks_ = 0;
};

}  // namespace kelpie::simulator
