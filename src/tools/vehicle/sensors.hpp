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

/// Errors of the velocity sensors. Scale, bias and strength of the white noise are drawn once per
/// run and axis, white noise at every measurement.
struct SensorNoise {
  double scale = 0.0;            ///< relative error of surge and sway, drawn in ±scale
  double bias_m_s = 0.0;         ///< drawn in ±bias
  double least_white_m_s = 0.0;  ///< standard deviation, drawn between least and greatest
  double greatest_white_m_s = 0.0;
  double yaw_white_rad_s = 0.0;
};

/// "none", "as_recorded", "raw_dvl" or "stress"; figures in docs/vehicle.md. Throws InputError.
SensorNoise noise_preset(const std::string& name);

/// Measured velocities: surge, sway [m/s], yaw rate [rad/s].
class VelocitySensors {
 public:
  /// Draws factors and biases.
  VelocitySensors(const SensorNoise& noise, std::uint64_t seed);

  /// Adds a fault, from the next measurement on.
  void set_fault(const SensorFault& fault) { fault_ = fault; }

  Eigen::Vector3d measure(const Eigen::Vector3d& velocity);  ///< One measurement.

 private:
  RandomStream stream_;
  Eigen::Vector3d factor_, bias_, white_;
  SensorFault fault_;
  Eigen::Vector3d shown_ = Eigen::Vector3d::Zero();
};

/// Accelerations from evenly spaced measurements, as a differentiating navigation filter gives
/// them: at every measurement the slope per second of the least-squares line through the
/// measurements within `half_window_s` on either side (fewer at the ends, at least the two
/// neighbours). A filter of fixed lag works like this, and the real log shows no lag. Requires at
/// least two measurements.
std::vector<Eigen::Vector3d> smoothed_slopes(std::span<const Eigen::Vector3d> measurements,
                                             double period_s, double half_window_s);

}  // namespace kelpie::vehicle
