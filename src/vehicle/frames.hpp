// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "log/frame.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// Surge, sway and yaw in FLU, as in a log, of a six-vector in FRD.
inline Eigen::Vector3d planar_flu(const Vector6& frd) {
  const log::Triple linear =
      log::converted({frd(0), frd(1), frd(2)}, log::Frame::frd, log::Frame::flu);
  const log::Triple angular =
      log::converted({frd(3), frd(4), frd(5)}, log::Frame::frd, log::Frame::flu);
  return {linear[0], linear[1], angular[2]};
}

/// The six-vector in FRD with surge, sway and yaw as given in FLU and the rest zero.
inline Vector6 from_planar_flu(const Eigen::Vector3d& planar) {
  const log::Triple linear =
      log::converted({planar(0), planar(1), 0.0}, log::Frame::flu, log::Frame::frd);
  const log::Triple angular =
      log::converted({0.0, 0.0, planar(2)}, log::Frame::flu, log::Frame::frd);
  return (Vector6() << linear[0], linear[1], linear[2], angular[0], angular[1], angular[2])
      .finished();
}

}  // namespace kelpie::vehicle
