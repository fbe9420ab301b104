// SPDX-License-Identifier: Apache-2.0
#include "simulator/battery.hpp"

#include <algorithm>
#include <cmath>

#include "core/seconds.hpp"

namespace kelpie::simulator {
double thruster_power_w(const VehicleParameters& vehicle, const RotorSpeeds& speeds_rps,
                        double factor) {
  double power = 0.0;
  if (vehicle.battery.thruster_w == 0.0) {
    return power;
  }
  for (Eigen::Index i = 0; i < speeds_rps.size(); ++i) {
    const Thruster& thruster = vehicle.thrusters[static_cast<std::size_t>(i)];
    const double share = factor * std::abs(thrust(thruster, speeds_rps(i))) /
                         thrust(thruster, thruster.max_speed_rps);
    power += vehicle.battery.thruster_w * std::pow(share, 1.5);
  }
  return power;
}

Battery::Battery(const BatteryParameters& parameters) : parameters_(parameters) {
  draw(0.0, 0.0);
}

void Battery::draw(double power_w, double period_s) {
  if (parameters_.nominal_v == 0.0) {
    return;
  }
  const double empty = std::min(1.0, drawn_as_ / (parameters_.capacity_ah * kSecondsPerHour));
  const double open_v = std::lerp(parameters_.full_v, parameters_.empty_v, empty);
  // V = E − R I and P = V I, so V² − E V + R P = 0.
  const double root =
      open_v * open_v - 4.0 * parameters_.resistance_ohm * (power_w + parameters_.idle_w);
  voltage_v_ = 0.5 * (open_v + std::sqrt(std::max(0.0, root)));
  drawn_as_ += (power_w + parameters_.idle_w) / voltage_v_ * period_s;
}

double Battery::thrust_factor() const {
  return parameters_.nominal_v == 0.0
             ? 1.0
             : std::pow(voltage_v_ / parameters_.nominal_v, parameters_.exponent);
}

}  // namespace kelpie::simulator
