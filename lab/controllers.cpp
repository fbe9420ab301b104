// SPDX-License-Identifier: Apache-2.0
#include "lab/controllers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vehicle/dynamics.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::lab {
namespace {

Eigen::Vector3d planar(const vehicle::Vector6& frd) {
  return {frd(0), frd(1), frd(5)};
}

// Forces in FLU of one newton of a thruster that is given in FRD.
Eigen::Vector3d flu_axis(const vehicle::Thruster& thruster) {
  const vehicle::Vector6 axis = vehicle::thrust_axis(thruster);
  return {axis(0), -axis(1), -axis(5)};
}

class PidController final : public Controller {
 public:
  PidController(const NominalModel& model, bool feed_forward)
      : model_(model), feed_forward_(feed_forward), pid_(PidGains{}) {}

  Eigen::Vector3d update(const Reference& reference, const Sensed& sensed) override {
    const TrackingError error = tracking_error(reference, sensed);
    Eigen::Vector3d acceleration = pid_.update(error, kControlPeriodS);
    Eigen::Vector3d forces = model_.mass.cwiseProduct(acceleration);
    if (feed_forward_) {
      forces += model_.mass.cwiseProduct(error.acceleration) + model_.resistance(error.wanted);
    }
    const Eigen::Vector3d commands = model_.allocate(forces);
    if ((commands.cwiseAbs().array() >= model_.most_rps.array()).any()) {
      pid_.saturated();
    }
    return commands;
  }

 private:
  NominalModel model_;
  bool feed_forward_;
  Pid pid_;
};

}  // namespace

NominalModel::NominalModel(const vehicle::VehicleParameters& vehicle)
    : mass(planar(vehicle::make_plant(vehicle, {}).mass.diagonal())),
      linear(planar(vehicle.linear_damping)),
      quadratic(planar(vehicle.quadratic_damping)),
      thrusters{vehicle.thrusters[vehicle::kSurgeLeft], vehicle.thrusters[vehicle::kSurgeRight],
                vehicle.thrusters[vehicle::kSway]} {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const vehicle::Thruster& thruster = thrusters[static_cast<std::size_t>(i)];
    by_thrust.col(i) = flu_axis(thruster);
    most_rps(i) = thruster.max_speed_rps;
  }
}

Eigen::Vector3d NominalModel::allocate(const Eigen::Vector3d& forces) const {
  const Eigen::Vector3d thrusts = by_thrust.inverse() * forces;
  Eigen::Vector3d speeds;
  for (Eigen::Index i = 0; i < 3; ++i) {
    speeds(i) = vehicle::speed_for_thrust(thrusters[static_cast<std::size_t>(i)], thrusts(i));
  }
  return speeds;
}

Eigen::Vector3d NominalModel::forces(const Eigen::Vector3d& speeds_rps) const {
  Eigen::Vector3d thrusts;
  for (Eigen::Index i = 0; i < 3; ++i) {
    thrusts(i) = vehicle::thrust(thrusters[static_cast<std::size_t>(i)], speeds_rps(i));
  }
  return by_thrust * thrusts;
}

Eigen::Vector3d NominalModel::resistance(const Eigen::Vector3d& velocity) const {
  const double u = velocity.x();
  const double v = velocity.y();
  const double r = velocity.z();
  const Eigen::Vector3d coriolis(-mass.y() * v * r, mass.x() * u * r,
                                 (mass.y() - mass.x()) * u * v);
  return coriolis + (linear + quadratic.cwiseProduct(velocity.cwiseAbs())).cwiseProduct(velocity);
}

TrackingError tracking_error(const Reference& reference, const Sensed& sensed) {
  const Eigen::Rotation2Dd to_body(-sensed.pose.z());
  const Eigen::Rotation2Dd from_reference(reference.pose.z() - sensed.pose.z());
  TrackingError error;
  error.pose.head<2>() = to_body * (reference.pose - sensed.pose).head<2>();
  error.pose.z() = std::remainder(reference.pose.z() - sensed.pose.z(), 2.0 * std::numbers::pi);
  error.wanted << from_reference * Eigen::Vector2d(reference.speed, 0.0), reference.yaw_rate;
  error.velocity = error.wanted - sensed.velocity;
  const double r = sensed.velocity.z();
  const Eigen::Vector2d turned =
      from_reference * Eigen::Vector2d(reference.speed_rate, reference.speed * reference.yaw_rate);
  // The wanted velocity as the turning body sees it.
  error.acceleration << turned.x() + r * error.wanted.y(), turned.y() - r * error.wanted.x(),
      reference.yaw_rate_rate;
  return error;
}

Eigen::Vector3d Pid::update(const TrackingError& error, double dt_s) {
  before_ = sum_;
  sum_ += dt_s * gains_.i.cwiseProduct(error.pose);
  return gains_.p.cwiseProduct(error.pose) + gains_.d.cwiseProduct(error.velocity) + sum_;
}

std::unique_ptr<Controller> make_pid(const NominalModel& model, bool feed_forward) {
  return std::make_unique<PidController>(model, feed_forward);
}

}  // namespace kelpie::lab
