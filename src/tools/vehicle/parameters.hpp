// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <string>

namespace kelpie::vehicle {

// All quantities in this room are SI, in the body frame FRD (x forward, y right, z down) about the
// centre of origin, and in the world frame NED, unless a name says otherwise. Six-vectors are
// ordered surge, sway, heave, roll, pitch, yaw.
using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< Surge, sway, heave, roll, pitch, yaw.
using Matrix6 = Eigen::Matrix<double, 6, 6>;  ///< In the order of Vector6.

inline constexpr double kGravity = 9.81;  ///< m/s²

/// The thrusters of Dagon.
enum ThrusterIndex : std::size_t {
  kSurgeLeft,
  kSurgeRight,
  kSway,
  kVerticalFront,
  kVerticalRear,
  kThrusterCount
};

/// One number per thruster, in the order of ThrusterIndex.
using RotorSpeeds = Eigen::Matrix<double, kThrusterCount, 1>;  ///< rev/s

/// A fixed thruster with the force K± n|n| along `direction`.
struct Thruster {
  double forward = 0.0;  ///< K for n > 0, N/(rev/s)²
  double reverse = 0.0;  ///< K for n < 0, N/(rev/s)²
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of the force for n > 0; unit length
  double max_speed_rps = 0.0;
};

/// Gains of the depth PID and the pitch PD of the two vertical thrusters.
struct HoldGains {
  double depth_p = 0.0;  ///< N/m
  double depth_i = 0.0;  ///< N/(m s)
  double depth_d = 0.0;  ///< N s/m
  double pitch_p = 0.0;  ///< N m/rad
  double pitch_d = 0.0;  ///< N m s/rad
};

/// A vehicle as built: coefficients of Fossen's equation, and actuators.
struct VehicleParameters {
  double mass_kg = 0.0;
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  ///< about the centre of gravity
  Eigen::Vector3d centre_of_gravity_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre_of_buoyancy_m = Eigen::Vector3d::Zero();
  double net_buoyancy_n = 0.0;                  ///< buoyancy − weight; positive: rises
  Matrix6 added_mass = Matrix6::Zero();         ///< kg, kg m, kg m²; symmetric
  Vector6 linear_damping = Vector6::Zero();     ///< N s/m, N m s/rad
  Vector6 quadratic_damping = Vector6::Zero();  ///< N s²/m², N m s²/rad²
  std::array<Thruster, kThrusterCount> thrusters{};
  double rotor_lag_s = 0.0;  ///< time constant of the rotors; 0: immediate response
  HoldGains hold;

  /// Throws InputError whose field is the key in a vehicle file ("body.mass_kg").
  void validate() const;
};

/// A rigidly fixed payload.
struct Payload {
  double mass_kg = 0.0;                                     ///< negative: removed mass
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();     ///< of the centre of gravity
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  ///< about the centre of gravity
  Matrix6 added_mass = Matrix6::Zero();                     ///< about the vehicle's origin
  double buoyancy_n = 0.0;                                  ///< acts at `position_m`
};

/// Faults of the sensors of surge, sway [m/s] and yaw rate [rad/s] (logged in FLU).
struct SensorFault {
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();   ///< factor on the true value
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();    ///< added after the factor
  Eigen::Vector3d frozen = Eigen::Vector3d::Zero();  ///< 1: repeats its last value; 0: works
};

/// Differences from the vehicle as built.
struct Configuration {
  std::string name;
  RotorSpeeds effectiveness = RotorSpeeds::Ones();  ///< factor on each thruster's force
  Vector6 damping_factor = Vector6::Ones();         ///< on linear and quadratic damping alike
  Payload payload;
  Eigen::Vector3d pull_n = Eigen::Vector3d::Zero();           ///< constant in the body, FRD
  Eigen::Vector3d pull_position_m = Eigen::Vector3d::Zero();  ///< point of action of the pull
  SensorFault sensors;

  /// Throws InputError whose field is the key below `field` ("configurations[0].damping_factor").
  void validate(const std::string& field) const;
};

/// Names in files, in the order of ThrusterIndex.
const std::array<std::string, kThrusterCount>& thruster_names();

/// K± n|n|, in N.
double thrust(const Thruster& thruster, double speed_rps);

/// The speed for `force_n`, clamped to ±max_speed_rps.
double speed_for_thrust(const Thruster& thruster, double force_n);

/// Force and moment of one newton of thrust: direction, and position × direction.
Vector6 thrust_axis(const Thruster& thruster);

}  // namespace kelpie::vehicle
