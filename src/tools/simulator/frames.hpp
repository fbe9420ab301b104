// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "kelpie/motion/frame.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// Surge, sway and yaw in FLU, as in a log, of a six-vector in FRD.
inline Eigen::Vector3d planar_flu(const Vector6& frd) {
  const Triple linear = converted({frd(0), frd(1), frd(2)}, Frame::frd, Frame::flu);
  const Triple angular = converted({frd(3), frd(4), frd(5)}, Frame::frd, Frame::flu);
  return {linear[0], linear[1], angular[2]};
}

/// The six-vector in FRD with surge, sway and yaw as given in FLU and the rest zero.
inline Vector6 from_planar_flu(const Eigen::Vector3d& planar) {
  const Triple linear = converted({planar(0), planar(1), 0.0}, Frame::flu, Frame::frd);
  const Triple angular = converted({0.0, 0.0, planar(2)}, Frame::flu, Frame::frd);
  return (Vector6() << linear[0], linear[1], linear[2], angular[0], angular[1], angular[2])
      .finished();
}

/// Roll, pitch, heading (Fossen 2011, eq. 2.29 to 2.31 of the rotation matrix).
inline Eigen::Vector3d euler_angles(const Eigen::Quaterniond& attitude) {
  const Eigen::Matrix3d to_world = attitude.toRotationMatrix();
  return {std::atan2(to_world(2, 1), to_world(2, 2)),
          std::asin(std::clamp(-to_world(2, 0), -1.0, 1.0)),
          std::atan2(to_world(1, 0), to_world(0, 0))};
}

}  // namespace kelpie::simulator
