// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "kelpie/model/dynamics_model.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::lab {

// Planar, in FLU: x ahead, y to port, angles to port; the world frame is the body frame at the
// start.

/// Position x, y [m] and heading [rad].
using Pose2 = Eigen::Vector3d;

/// The reference of a mission at a moment.
struct Reference {
  Pose2 pose = Pose2::Zero();
  double speed = 0.0;          ///< along the heading [m/s]
  double speed_rate = 0.0;     ///< [m/s²]
  double yaw_rate = 0.0;       ///< [rad/s]
  double yaw_rate_rate = 0.0;  ///< [rad/s²]
};

/// Paths, smooth up to the acceleration.
enum class PathKind {
  lawn_mower,       ///< legs, joined by half turns
  figure_of_eight,  ///< heading 2.405 sin(ωt): closes since J₀(2.405) = 0
  station,          ///< stays at the start
};
inline constexpr std::array kPaths{PathKind::lawn_mower, PathKind::figure_of_eight,
                                   PathKind::station};

std::string path_name(PathKind kind);

/// A path in time, at 0.15 m/s after the start.
class MissionPath {
 public:
  explicit MissionPath(PathKind kind) : kind_(kind) {}

  /// The reference `dt_s` later.
  const Reference& advance(double dt_s);
  const Reference& reference() const { return reference_; }

 private:
  void place(double time_s);

  PathKind kind_;
  double time_s_ = 0.0;
  Reference reference_;
};

/// The measurements for a controller: planar, FLU.
struct Sensed {
  double time_s = 0.0;
  Pose2 pose = Pose2::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< surge, sway, yaw rate over ground
  Eigen::Vector3d rotors_rps = Eigen::Vector3d::Zero();
  /// Neither the velocity log nor the position measures: surge, sway, x and y are meaningless.
  bool silent = false;
};

/// The vehicle in the plane, undamaged: the model for the design of controllers.
struct NominalModel {
  explicit NominalModel(const simulator::VehicleParameters& vehicle);

  /// Rotor speeds for forces ahead and to port [N] and a moment to port [N m], within their limits.
  Eigen::Vector3d allocate(const Eigen::Vector3d& forces) const;
  /// Forces and moment of rotor speeds.
  Eigen::Vector3d forces(const Eigen::Vector3d& speeds_rps) const;
  /// Thrust of each rotor at its speed [N], and speeds for thrusts, within their limits.
  Eigen::Vector3d thrusts(const Eigen::Vector3d& speeds_rps) const;
  Eigen::Vector3d speeds(const Eigen::Vector3d& thrusts_n) const;
  /// Coriolis and drag forces at a velocity.
  Eigen::Vector3d resistance(const Eigen::Vector3d& velocity) const;

  Eigen::Vector3d mass;       ///< with added mass: kg, kg, kg m²
  Eigen::Vector3d linear;     ///< drag
  Eigen::Vector3d quadratic;  ///< drag
  std::array<simulator::Thruster, 3> thrusters;
  Eigen::Matrix3d by_thrust;  ///< forces by thrusts
  Eigen::Vector3d most_rps;
  double lag_s;  ///< of the rotors
};

/// The deviation from the reference, in the body frame.
struct TrackingError {
  Eigen::Vector3d pose;          ///< reference less measurement
  Eigen::Vector3d velocity;      ///< reference less measurement
  Eigen::Vector3d acceleration;  ///< ν̇ of the reference at the vehicle's heading
  Eigen::Vector3d wanted;        ///< ν of the reference
};
TrackingError tracking_error(const Reference& reference, const Sensed& sensed);

/// Gains of a PID on acceleration, found on the nominal vehicle (docs/measured/applications.md).
struct PidGains {
  Eigen::Vector3d p{0.36, 0.25, 0.64};    ///< 1/s²
  Eigen::Vector3d d{1.1, 0.9, 1.5};       ///< 1/s
  Eigen::Vector3d i{0.030, 0.020, 0.05};  ///< 1/s³
};

/// Accelerations in addition to a feed-forward. The integral stops while the thrusters are
/// saturated, and turns with the body.
class Pid {
 public:
  explicit Pid(PidGains gains) : gains_(std::move(gains)) {}

  Eigen::Vector3d update(const TrackingError& error, double dt_s);
  /// Takes the last step of the integral back, after saturated thrusters.
  void saturated() { sum_ = before_; }
  /// Takes an acceleration out of the integral, as far as the integral holds this acceleration:
  /// another part of the controller supplies it from now on.
  void hand_over(const Eigen::Vector3d& acceleration) {
    sum_ -= acceleration.cwiseMax(sum_.cwiseMin(0.0)).cwiseMin(sum_.cwiseMax(0.0));
  }

 private:
  PidGains gains_;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d before_ = Eigen::Vector3d::Zero();
};

/// Rotor commands from measurements and the reference, once per period.
class Controller {
 public:
  virtual ~Controller() = default;
  virtual Eigen::Vector3d update(const Reference& reference, const Sensed& sensed) = 0;
  /// Share of the time in which the controller fell back on a simpler law.
  virtual double fallback_share() const { return 0.0; }
};

inline constexpr double kControlPeriodS = 0.1;

/// (a) PID alone. (b) PID with the nominal model's forces for the reference. (e) As (b), with
/// commands by a Reallocation whose diagnosis goes on from `diagnosis`, if given. Outages are
/// bridged by the nominal model's equation of motion, here and in (d).
std::unique_ptr<Controller> make_pid(const NominalModel& model, bool feed_forward,
                                     const Diagnosis* diagnosis = nullptr);

/// (d) Slotine and Li's adaptive law: masses, drag, coupling and a constant force per axis are
/// adapted from their nominal values.
std::unique_ptr<Controller> make_adaptive(const NominalModel& model);

/// (g) Model predictive control on the nominal model with its rotors' lag and limits: 3 s ahead,
/// the reference continued by its accelerations, solved as a quadratic program linearised along the
/// last plan. A Kalman filter estimates pose, velocity and a constant force beside the model, and
/// bridges outages.
std::unique_ptr<Controller> make_predictive(const NominalModel& model);

/// Accelerations: the slope of the least-squares line through the last measurements, an odd number,
/// at the time of the middle measurement.
class SlopeWindow {
 public:
  /// Takes a measurement; a silent one begins anew. Returns the middle measurement and the
  /// accelerations of a full window.
  std::optional<std::pair<Sensed, Eigen::Vector3d>> add(const Sensed& sensed);

 private:
  static constexpr std::size_t kCount = 5;

  std::array<Sensed, kCount> ring_{};
  std::size_t seen_ = 0;
};

/// The untaught model of (c): u, v, r and three rotor speeds to three accelerations.
DynamicsModel untaught_model();

/// (c) The accelerations of PID and reference by the learned model:
///
///     f(ν_reference, n) + d = a_reference + a_PID,
///
/// solved for n by a few damped Gauss-Newton steps on the model's Jacobian from the nominal model's
/// commands. d is the model's present disturbance. The forces added to the nominal model's are
/// averaged over half a second and more, and stay within a twentieth of the greatest thrust around
/// the force seen by a disturbance observer. The observer gradually replaces a model of high
/// novelty or with wide intervals, and an invalid solution. Outages are bridged by DeadReckoning
/// with the model. (f): with `reallocates`, commands and forces are those of a Reallocation by the
/// model's diagnosis.
std::unique_ptr<Controller> make_learned(const NominalModel& nominal, DynamicsModel model,
                                         bool reallocates = false);

}  // namespace kelpie::lab
