// SPDX-License-Identifier: Apache-2.0
#include "vehicle/thrusters.hpp"

#include <algorithm>
#include <cmath>

namespace kelpie::vehicle {

const std::array<std::string, kThrusterCount>& thruster_names() {
  static const std::array<std::string, kThrusterCount> names = {"surge_left", "surge_right", "sway",
                                                                "vertical_front", "vertical_rear"};
  return names;
}

double thrust(const Thruster& thruster, double speed_rps) {
  const double coefficient = speed_rps < 0.0 ? thruster.reverse : thruster.forward;
  return coefficient * speed_rps * std::abs(speed_rps);
}

double speed_for_thrust(const Thruster& thruster, double force_n) {
  const double coefficient = force_n < 0.0 ? thruster.reverse : thruster.forward;
  const double speed = std::copysign(std::sqrt(std::abs(force_n) / coefficient), force_n);
  return std::clamp(speed, -thruster.max_speed_rps, thruster.max_speed_rps);
}

Vector6 thrust_axis(const Thruster& thruster) {
  return (Vector6() << thruster.direction, thruster.position_m.cross(thruster.direction))
      .finished();
}

}  // namespace kelpie::vehicle
