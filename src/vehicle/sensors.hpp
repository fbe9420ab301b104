// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::vehicle {

/// Errors of the velocity sensors. What belongs to the instrument (scale, bias, strength of the
/// white noise) is drawn once per run and axis, white noise at every measurement.
struct SensorNoise {
  double scale = 0.0;            ///< relative error of surge and sway, drawn in ±scale
  double bias_m_s = 0.0;         ///< drawn in ±bias
  double least_white_m_s = 0.0;  ///< standard deviation, drawn between least and greatest
  double greatest_white_m_s = 0.0;
  double yaw_white_rad_s = 0.0;
};

/// "none", "as_recorded", "raw_dvl" or "stress"; figures in docs/vehicle.md. Throws InputError.
SensorNoise noise_preset(const std::string& name);

/// Velocities as the instruments give them: surge, sway [m/s], yaw rate [rad/s].
class VelocitySensors {
 public:
  /// Draws what stays: factors and biases.
  VelocitySensors(const SensorNoise& noise, std::uint64_t seed);

  /// From here on the instruments have this fault as well.
  void set_fault(const SensorFault& fault) { fault_ = fault; }

  Eigen::Vector3d measure(const Eigen::Vector3d& velocity);  ///< One measurement.

 private:
  RandomStream stream_;
  Eigen::Vector3d factor_, bias_, white_;
  SensorFault fault_;
  Eigen::Vector3d shown_ = Eigen::Vector3d::Zero();
};

/// What a differentiating navigation filter makes of evenly spaced measurements: at every one the
/// slope of the least-squares line through those within `half_window_s` either side (fewer at the
/// ends), per second. A filter of fixed lag can do so, and the real log shows no lag.
/// Requires at least two measurements; the window holds at least the two neighbours.
std::vector<Eigen::Vector3d> smoothed_slopes(std::span<const Eigen::Vector3d> measurements,
                                             double period_s, double half_window_s);

}  // namespace kelpie::vehicle
