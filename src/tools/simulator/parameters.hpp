// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace kelpie::simulator {

// All quantities in this room are SI, in the body frame FRD (x forward, y right, z down) about the
// centre of origin, and in the world frame NED, unless a name says otherwise. Six-vectors are
// ordered surge, sway, heave, roll, pitch, yaw.
using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< Surge, sway, heave, roll, pitch, yaw.
using Matrix6 = Eigen::Matrix<double, 6, 6>;  ///< In the order of Vector6.

inline constexpr double kGravity = 9.81;  ///< m/s²

/// The thrusters of a vehicle that is driven in the plane (drives_in_plane()), such as Dagon.
enum ThrusterIndex : std::size_t {
  kSurgeLeft,
  kSurgeRight,
  kSway,
  kVerticalFront,
  kVerticalRear,
  kPlanarThrusterCount
};

inline constexpr int kMostThrusters = 16;  ///< as many as SERVO_OUTPUT_RAW has outputs

/// One number per thruster, in the vehicle's order; at most kMostThrusters, never on the heap.
using RotorSpeeds = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostThrusters, 1>;
/// A wrench per thruster.
using ThrustAxes = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMostThrusters>;

/// Meaning of a thruster's command.
enum class CommandUnit {
  speed,  ///< rev/s, up to the thruster's greatest speed
  share,  ///< −1 to 1 of the greatest speed
  pwm,    ///< pulse in µs: 1500 is 0, 1100 and 1900 the greatest speed; whole numbers
};

CommandUnit command_unit_from(const std::string& name);  ///< Throws InputError.
const char* command_unit_name(CommandUnit unit);         ///< As in a vehicle file.

/// A fixed thruster with the force K± n|n| along `direction`.
struct Thruster {
  double forward = 0.0;  ///< K for n > 0: N/(rev/s)², or N at the greatest speed
  double reverse = 0.0;  ///< K for n < 0: N/(rev/s)², or N at the greatest speed
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of the force for n > 0; unit length
  double max_speed_rps = 0.0;  ///< 1 unless commands are speeds: n is then a share of the greatest
  double dead_band = 0.0;      ///< commands up to this share of the greatest stop the rotor
  std::string name{};          ///< key in the vehicle file
};

/// Supply of the thrusters. The force of a thruster grows with voltage^exponent, and the thruster
/// draws thruster_w · (force / greatest forward force)^1.5 (momentum theory).
struct BatteryParameters {
  double nominal_v = 0.0;       ///< of the thrust coefficients; 0: no battery, nominal supply
  double full_v = 0.0;          ///< without load, charged
  double empty_v = 0.0;         ///< without load, after capacity_ah; linear between
  double resistance_ohm = 0.0;  ///< internal, and of the cables
  double capacity_ah = 0.0;
  double thruster_w = 0.0;  ///< of a thruster at its full forward force and nominal voltage
  double idle_w = 0.0;      ///< electronics
  double exponent = 0.0;    ///< of the force over the voltage
};

/// Gains of the PID on depth and the PDs on pitch and roll.
struct HoldGains {
  double depth_p = 0.0;  ///< N/m
  double depth_i = 0.0;  ///< N/(m s)
  double depth_d = 0.0;  ///< N s/m
  double pitch_p = 0.0;  ///< N m/rad
  double pitch_d = 0.0;  ///< N m s/rad
  double roll_p = 0.0;   ///< N m/rad; 0 where the vehicle is driven in the plane
  double roll_d = 0.0;   ///< N m s/rad; 0 where the vehicle is driven in the plane
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
  std::vector<Thruster> thrusters{};            ///< 1 to kMostThrusters
  CommandUnit command_unit = CommandUnit::speed;
  double rotor_lag_s = 0.0;    ///< time constant of the rotors; 0: immediate response
  double rotor_rate = 0.0;     ///< greatest change of speed per s; 0: any
  double rotor_delay_s = 0.0;  ///< from a command to the rotor; whole ticks
  BatteryParameters battery;
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
  /// Factor on each thruster's force; entries beyond the vehicle's thrusters have no effect.
  RotorSpeeds effectiveness = RotorSpeeds::Ones(kMostThrusters);
  Vector6 damping_factor = Vector6::Ones();  ///< on linear and quadratic damping alike
  Payload payload;
  Eigen::Vector3d pull_n = Eigen::Vector3d::Zero();           ///< constant in the body, FRD
  Eigen::Vector3d pull_position_m = Eigen::Vector3d::Zero();  ///< point of action of the pull
  SensorFault sensors;

  /// Throws InputError whose field is the key below `field` ("configurations[0].damping_factor").
  void validate(const std::string& field) const;
};

/// Names in files, in the order of ThrusterIndex.
const std::array<std::string, kPlanarThrusterCount>& planar_thruster_names();

/// Whether the thrusters are those of ThrusterIndex, by name and order, and commands are speeds:
/// the lateral thrusters can be excited one by one while the vertical thrusters hold depth and
/// pitch.
bool drives_in_plane(const VehicleParameters& vehicle);

/// Throws InputError unless drives_in_plane().
void require_plane(const VehicleParameters& vehicle);

/// The vehicle's commands to thrusters, in the unit of its files, of commands from −max_speed_rps
/// to max_speed_rps.
double command_in_unit(CommandUnit unit, double command);

/// Speed at which the rotor settles: the command without the dead band.
double speed_for_command(const Thruster& thruster, double command);

/// The command for a speed; inverse of speed_for_command() outside the dead band.
double command_for_speed(const Thruster& thruster, double speed_rps);

/// K± n|n|, in N.
double thrust(const Thruster& thruster, double speed_rps);

/// The speed for `force_n`, clamped to ±max_speed_rps.
double speed_for_thrust(const Thruster& thruster, double force_n);

/// Force and moment of one newton of thrust: direction, and position × direction.
Vector6 thrust_axis(const Thruster& thruster);

/// thrust_axis() of every thruster.
ThrustAxes thrust_axes(const std::vector<Thruster>& thrusters);

}  // namespace kelpie::simulator
