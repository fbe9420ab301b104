// SPDX-License-Identifier: Apache-2.0
#include "kelpie/identify/planar_fit.hpp"

#include <cmath>

namespace kelpie {

PlanarVector PlanarVehicle::acceleration(std::span<const double, kPlanarAxes> velocity,
                                         std::span<const double> speeds) const {
  const auto [u, v, r] = PlanarVector{velocity[0], velocity[1], velocity[2]};
  const double sway_momentum = sway_inertia * v + sway_yaw_inertia * r;
  PlanarVector force{r * sway_momentum, -r * surge_inertia * u,
                     v * surge_inertia * u - u * sway_momentum};
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    force[axis] += constant_force[axis] - linear_drag[axis] * velocity[axis] -
                   quadratic_drag[axis] * std::abs(velocity[axis]) * velocity[axis];
  }
  for (std::size_t i = 0; i < thrusters.size(); ++i) {
    const PlanarThruster& thruster = thrusters[i];
    const double thrust =
        (speeds[i] > 0.0 ? thruster.forward : thruster.reverse) * speeds[i] * std::abs(speeds[i]);
    force[0] += thrust * std::cos(thruster.angle_rad);
    force[1] += thrust * std::sin(thruster.angle_rad);
    force[2] += thrust * thruster.arm_m;
  }
  const double determinant = sway_inertia * yaw_inertia - sway_yaw_inertia * sway_yaw_inertia;
  return {force[0] / surge_inertia,
          (yaw_inertia * force[1] - sway_yaw_inertia * force[2]) / determinant,
          (sway_inertia * force[2] - sway_yaw_inertia * force[1]) / determinant};
}

}  // namespace kelpie
