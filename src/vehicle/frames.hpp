// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// Logs are FLU (x forward, y left, z up): a half turn about x from FRD, so y and z change sign,
/// in velocities, accelerations and rates alike. The flip is its own inverse.
inline Vector6 flip_flu_frd(const Vector6& value) {
  return (Vector6() << value(0), -value(1), -value(2), value(3), -value(4), -value(5)).finished();
}

/// Surge, sway and yaw in FLU, as in a log, of a six-vector in FRD.
inline Eigen::Vector3d planar_flu(const Vector6& frd) {
  const Vector6 flu = flip_flu_frd(frd);
  return {flu(0), flu(1), flu(5)};
}

/// The six-vector in FRD with surge, sway and yaw as given in FLU and the rest zero.
inline Vector6 from_planar_flu(const Eigen::Vector3d& planar) {
  return flip_flu_frd((Vector6() << planar(0), planar(1), 0, 0, 0, planar(2)).finished());
}

}  // namespace kelpie::vehicle
