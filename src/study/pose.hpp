// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace kelpie::study {

/// Position [m] and heading [rad] from surge, sway and yaw rate, by the middle of each step.
struct Pose {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;

  void advance(double surge, double sway, double yaw, double dt_s) {
    const double middle = heading + 0.5 * yaw * dt_s;
    x += (surge * std::cos(middle) - sway * std::sin(middle)) * dt_s;
    y += (surge * std::sin(middle) + sway * std::cos(middle)) * dt_s;
    heading += yaw * dt_s;
  }
};

}  // namespace kelpie::study
