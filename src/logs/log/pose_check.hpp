// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "log/log_source.hpp"
#include "log/plausibility.hpp"

namespace kelpie::log {

/// Velocities beside the pose of the same log, row by row in time order; NaN: not measured.
struct PoseTrack {
  std::vector<double> times_s;
  std::vector<double> x, y;  ///< [m]
  std::vector<double> yaw;   ///< [rad], about the axis from x to y
  std::vector<double> u, v;  ///< [m/s], as the log has them
  std::vector<double> r;     ///< [rad/s], likewise; empty: not measured
};

/// What the ways between poses tell of the velocities: means over windows of 2 and 8 s as complex
/// numbers, the way against the velocities turned by yaw. Rotations of the world, mirrored worlds
/// (a compass beside east and north) and a steady current are no mistakes.
struct PoseFinding {
  double share = 0.0;     ///< of the ways that velocities explain, at best
  bool is_world = false;  ///< u and v lie along the axes of the world, and are certainly not turned
  std::vector<Mistake> mistakes{};
};

/// Names of the columns for messages, as "vx", "vy", "r", "psi".
struct PoseNames {
  std::string u, v, r, yaw;
  std::string pose;  ///< "x,y,psi": for --pose
};

/// Empty where the vehicle hardly moves or turns. Cost O(rows).
PoseFinding check_pose(const PoseTrack& track, const PoseNames& names);

/// The same of the columns of a table with known names.
PoseFinding check_pose(const Table& table, const Roles& given);

/// Whether the twist of an odometry topic lies along the axes of the world, by the poses of the
/// same messages. Reads the recording to the end.
bool is_twist_of_world(const LogSource& source, const std::string& topic);

}  // namespace kelpie::log
