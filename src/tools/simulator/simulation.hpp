// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "simulator/scenario.hpp"

namespace kelpie::simulator {

/// One row of a simulated log. Planar: surge, sway, yaw, in FLU.
struct LogRow {
  double t_s = 0.0;
  std::size_t configuration = 0;      ///< of the phase, also during its ramp
  Eigen::Vector3d velocity;           ///< measured, m/s, m/s, rad/s
  Eigen::Vector3d rotors_rps;         ///< surge left, surge right, sway
  Eigen::Vector3d acceleration;       ///< of a navigation filter, m/s², m/s², rad/s²
  Eigen::Vector3d true_acceleration;  ///< without sensors
};

/// One row of a log of six axes, FRD.
struct SixAxisRow {
  double t_s = 0.0;
  std::size_t configuration = 0;  ///< of the phase, also during its ramp
  Vector6 velocity;               ///< measured, m/s and rad/s
  Eigen::Vector3d attitude_rad;   ///< measured roll, pitch, heading
  RotorSpeeds commands;           ///< to the thrusters, in the vehicle's unit, at this instant
  double voltage_v = 0.0;         ///< 0 without a battery
  Vector6 acceleration;           ///< of a navigation filter, m/s² and rad/s²
  Vector6 true_acceleration;      ///< without sensors
};

class Simulator;
class SixAxisSensors;

/// The row of a log at the simulator's present instant, with a measured velocity; the attitude is
/// measured here. Commands are those of the last tick, in `unit`. Without accelerations, in
/// configuration 0.
SixAxisRow six_axis_row(const Simulator& simulator, CommandUnit unit, const Vector6& velocity,
                        SixAxisSensors& sensors);

/// Called now and then with the finished share, in [0, 1].
using Progress = std::function<void(double share)>;

/// Drives the scenario from rest. Returns duration × rate rows, the first after one sampling
/// interval. Requires a vehicle that drives_in_plane(). Equal scenarios give equal rows to the last
/// bit; the noise doesn't change commands and true motion. Throws InputError as validate() and
/// Simulator::advance() do.
std::vector<LogRow> simulate(const Scenario& scenario, const Progress& progress = {});

/// The rows of a drive, one at a time; none at the end.
using RowSource = std::function<std::optional<LogRow>()>;

/// The rows of simulate(), each as soon as its acceleration is known. Throws as simulate() does, in
/// this function and in the source.
RowSource drive_in_plane(Scenario scenario);

/// The same as simulate() for a log of six axes. Commands are those of the tick that ends at the
/// row, before delay, dead band and lag.
std::vector<SixAxisRow> simulate_six_axes(const Scenario& scenario, const Progress& progress = {});

}  // namespace kelpie::simulator
