// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::simulator {

/// Errors of the velocity sensors. Scale, bias and strength of the white noise are drawn once per
/// run and axis, white noise at every measurement.
struct SensorNoise {
  double scale = 0.0;            ///< relative error of surge and sway, drawn in ±scale
  double bias_m_s = 0.0;         ///< drawn in ±bias
  double least_white_m_s = 0.0;  ///< standard deviation, drawn between least and greatest
  double greatest_white_m_s = 0.0;
  double yaw_white_rad_s = 0.0;  ///< of every angular velocity
  double attitude_white_rad = 0.0;
};

/// "none", "as_recorded", "raw_dvl" or "stress"; see reference/simulator.md. Throws InputError.
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

/// Measured velocities and attitude of six axes, FRD: factor, bias and white noise of surge, sway
/// and heave, white noise of the angular velocities and of roll, pitch and heading.
class SixAxisSensors {
 public:
  /// Draws factors and biases.
  SixAxisSensors(const SensorNoise& noise, std::uint64_t seed);

  Vector6 measure(const Vector6& velocity);                             ///< One measurement.
  Eigen::Vector3d measure_attitude(const Eigen::Vector3d& angles_rad);  ///< One measurement.

 private:
  RandomStream stream_;
  Eigen::Vector3d factor_, bias_, white_;
  double rate_white_, attitude_white_;
};

/// Acceleration from evenly spaced measurements, as a differentiating navigation filter gives it:
/// at measurement `at` the slope per second of the least-squares line through the measurements up
/// to `half` on either side (fewer at the ends). A filter of fixed lag works like this, and the
/// real log shows no lag. Requires at least two measurements, at < measurements.size() and half
/// >= 1.
template <int axes>
Eigen::Matrix<double, axes, 1> smoothed_slope(
    std::span<const Eigen::Matrix<double, axes, 1>> measurements, std::size_t at, std::size_t half,
    double period_s);

extern template Eigen::Vector3d smoothed_slope<3>(std::span<const Eigen::Vector3d>, std::size_t,
                                                  std::size_t, double);
extern template Vector6 smoothed_slope<6>(std::span<const Vector6>, std::size_t, std::size_t,
                                          double);

}  // namespace kelpie::simulator
