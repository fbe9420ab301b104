// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <functional>
#include <vector>

#include "vehicle/scenario.hpp"

namespace kelpie::vehicle {

/// One row of the log that a scenario gives. Planar: surge, sway, yaw, in FLU.
struct LogRow {
  double t_s = 0.0;
  std::size_t configuration = 0;      ///< of the phase; while it ramps, the one it goes to
  Eigen::Vector3d velocity;           ///< as measured, m/s, m/s, rad/s
  Eigen::Vector3d rotors_rps;         ///< surge left, surge right, sway
  Eigen::Vector3d acceleration;       ///< as a navigation filter gives it, m/s², m/s², rad/s²
  Eigen::Vector3d true_acceleration;  ///< without sensors between
};

/// Called now and then with the share that is done, in [0, 1].
using Progress = std::function<void(double share)>;

/// Drives the scenario from rest and returns its rows, duration × rate of them, the first after one
/// sampling interval. The same scenario gives the same rows to the last bit; another noise leaves
/// commands and true motion as they were. Throws InputError as validate() does, Failure as
/// Simulator::advance does.
std::vector<LogRow> simulate(const Scenario& scenario, const Progress& progress = {});

}  // namespace kelpie::vehicle
