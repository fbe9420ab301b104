// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <string>

namespace kelpie::lab {

// Planar, in FLU: x ahead, y to port, angles to port; the world frame is the body frame at the
// start.

/// Position x, y [m] and heading [rad].
using Pose2 = Eigen::Vector3d;

/// The reference of a mission at a moment.
struct Reference {
  Pose2 pose = Pose2::Zero();
  double speed = 0.0;          ///< along the heading [m/s]
  double speed_rate = 0.0;     ///< [m/s²]
  double yaw_rate = 0.0;       ///< [rad/s]
  double yaw_rate_rate = 0.0;  ///< [rad/s²]
};

/// Paths, smooth up to the acceleration.
enum class PathKind {
  lawn_mower,       ///< legs, joined by half turns
  figure_of_eight,  ///< heading 2.405 sin(ωt): closes since J₀(2.405) = 0
  station,          ///< stays at the start
};
inline constexpr std::array kPaths{PathKind::lawn_mower, PathKind::figure_of_eight,
                                   PathKind::station};

std::string path_name(PathKind kind);

/// A path in time, at 0.15 m/s after the start.
class MissionPath {
 public:
  explicit MissionPath(PathKind kind) : kind_(kind) {}

  /// The reference `dt_s` later.
  const Reference& advance(double dt_s);
  const Reference& reference() const { return reference_; }

 private:
  void place(double time_s);

  PathKind kind_;
  double time_s_ = 0.0;
  Reference reference_;
};

}  // namespace kelpie::lab
