// SPDX-License-Identifier: Apache-2.0
// J.-J. E. Slotine, W. Li: On the adaptive control of robot manipulators, IJRR 6(3), 1987, with the
// vehicle's planar equations in place of the manipulator's.
#include "lab/controllers.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "lab/reallocation.hpp"
#include "lab/reckoners.hpp"
#include "simulator/dynamics.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::lab {
namespace {

Eigen::Vector3d planar(const simulator::Vector6& frd) {
  return {frd(0), frd(1), frd(5)};
}

// Forces in FLU of one newton of a thruster that is given in FRD.
Eigen::Vector3d flu_axis(const simulator::Thruster& thruster) {
  const simulator::Vector6 axis = simulator::thrust_axis(thruster);
  return {axis(0), -axis(1), -axis(5)};
}

class PidController final : public Controller {
 public:
  PidController(const NominalModel& model, bool feed_forward, const Diagnosis* diagnosis)
      : model_(model),
        feed_forward_(feed_forward),
        pid_(PidGains{}),
        reckoner_(make_nominal_reckoner(model)),
        reallocation_(model) {
    if (diagnosis != nullptr) {
      diagnosis_.emplace(*diagnosis);
    }
  }

  Eigen::Vector3d update(const Reference& reference, const Sensed& measured) override {
    const Sensed sensed = reckoner_->complete(measured);
    diagnose(measured);
    const TrackingError error = tracking_error(reference, sensed);
    const Eigen::Vector3d acceleration = pid_.update(error, kControlPeriodS);
    Eigen::Vector3d forces = model_.mass.cwiseProduct(acceleration);
    if (feed_forward_) {
      forces += model_.mass.cwiseProduct(error.acceleration) + model_.resistance(error.wanted);
    }
    Eigen::Vector3d commands = reallocation_.allocate(forces);
    if ((commands.cwiseAbs().array() >= model_.most_rps.array()).any()) {
      pid_.saturated();
    }
    return commands;
  }

 private:
  // At 5 Hz, as (c) learns.
  void diagnose(const Sensed& measured) {
    if (!diagnosis_) {
      return;
    }
    if (const auto sample = window_.add(measured); sample && ++measured_ % 2 == 0) {
      const auto& [middle, a] = *sample;
      diagnosis_->update(
          std::array{middle.velocity(0), middle.velocity(1), middle.velocity(2),
                     middle.rotors_rps(0), middle.rotors_rps(1), middle.rotors_rps(2)},
          std::array{a(0), a(1), a(2)}, middle.time_s);
    }
    // The integral has gathered what the re-allocation supplies from now on.
    const Eigen::Vector3d lost = reallocation_.look(&*diagnosis_, measured.rotors_rps);
    pid_.hand_over(lost.cwiseQuotient(model_.mass));
  }

  NominalModel model_;
  bool feed_forward_;
  Pid pid_;
  std::unique_ptr<Reckoner> reckoner_;
  Reallocation reallocation_;
  std::optional<Diagnosis> diagnosis_;
  SlopeWindow window_;
  std::size_t measured_ = 0;
};

constexpr int kParameters = 5;  // per axis: mass, coupling, linear and quadratic drag, a force
using Regressor = Eigen::Matrix<double, kParameters, 1>;

class AdaptiveController final : public Controller {
 public:
  explicit AdaptiveController(const NominalModel& model)
      : model_(model), reckoner_(make_nominal_reckoner(model)) {
    const Eigen::Vector3d& m = model.mass;
    const Eigen::Vector3d coupling(m.y(), m.x(), m.y() - m.x());
    for (int axis = 0; axis < 3; ++axis) {
      theta_.col(axis) << m(axis), coupling(axis), model.linear(axis), model.quadratic(axis), 0.0;
    }
    nominal_ = theta_;
  }

  Eigen::Vector3d update(const Reference& reference, const Sensed& measured) override {
    const Sensed sensed = reckoner_->complete(measured);
    const TrackingError error = tracking_error(reference, sensed);
    // ν_r = ν_d + Λ e, s = ν_r − ν: e converges wherever s does.
    const Eigen::Vector3d wanted = error.wanted + kLambda.cwiseProduct(error.pose);
    const Eigen::Vector3d acceleration = error.acceleration + kLambda.cwiseProduct(error.velocity);
    const Eigen::Vector3d s = wanted - sensed.velocity;
    Eigen::Vector3d forces = model_.mass.cwiseProduct(kDamping.cwiseProduct(s));
    const std::array<Regressor, 3> regressors =
        regressors_of(sensed.velocity, wanted, acceleration);
    for (int axis = 0; axis < 3; ++axis) {
      forces(axis) += theta_.col(axis).dot(regressors[static_cast<std::size_t>(axis)]);
    }
    Eigen::Vector3d commands = model_.allocate(forces);
    if ((commands.cwiseAbs().array() < model_.most_rps.array()).all()) {
      adapt(regressors, s);
    }
    return commands;
  }

 private:
  static std::array<Regressor, 3> regressors_of(const Eigen::Vector3d& velocity,
                                                const Eigen::Vector3d& wanted,
                                                const Eigen::Vector3d& acceleration) {
    const double r = velocity.z();
    const Eigen::Vector3d coupling(-wanted.y() * r, wanted.x() * r, velocity.x() * wanted.y());
    std::array<Regressor, 3> regressors;
    for (int axis = 0; axis < 3; ++axis) {
      regressors[static_cast<std::size_t>(axis)] << acceleration(axis), coupling(axis),
          wanted(axis), std::abs(velocity(axis)) * wanted(axis), 1.0;
    }
    return regressors;
  }

  // θ' = Γ Yᵀ s, Γ as large as the nominal parameters' squares, within what is physical.
  void adapt(const std::array<Regressor, 3>& regressors, const Eigen::Vector3d& s) {
    for (int axis = 0; axis < 3; ++axis) {
      const double m = nominal_(0, axis);
      const Regressor& y = regressors[static_cast<std::size_t>(axis)];
      for (int k = 0; k < kParameters; ++k) {
        const bool force = k == kParameters - 1;
        const double rate =
            force ? kForceRate * m : kShapeRate * nominal_(k, axis) * nominal_(k, axis) / m;
        const double value = theta_(k, axis) + kControlPeriodS * rate * y(k) * s(axis);
        const double most = force ? kMostAcceleration * m : 3.0 * std::abs(nominal_(k, axis));
        const double least = force ? -most : 0.3 * std::abs(nominal_(k, axis));
        theta_(k, axis) = force || nominal_(k, axis) >= 0.0 ? std::clamp(value, least, most)
                                                            : std::clamp(value, -most, -least);
      }
    }
  }

  // Found on the nominal and the damaged vehicle of seeds that the study doesn't use.
  inline static const Eigen::Vector3d kLambda{0.35, 0.3, 0.5};
  inline static const Eigen::Vector3d kDamping{0.9, 0.8, 1.2};
  static constexpr double kForceRate = 0.15;
  static constexpr double kShapeRate = 30.0;
  static constexpr double kMostAcceleration = 0.08;

  NominalModel model_;
  std::unique_ptr<Reckoner> reckoner_;
  Eigen::Matrix<double, kParameters, 3> theta_;
  Eigen::Matrix<double, kParameters, 3> nominal_;
};

}  // namespace

NominalModel::NominalModel(const simulator::VehicleParameters& vehicle)
    : mass(planar(simulator::make_plant(vehicle, {}).mass.diagonal())),
      linear(planar(vehicle.linear_damping)),
      quadratic(planar(vehicle.quadratic_damping)),
      thrusters{vehicle.thrusters[simulator::kSurgeLeft], vehicle.thrusters[simulator::kSurgeRight],
                vehicle.thrusters[simulator::kSway]},
      lag_s(vehicle.rotor_lag_s) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const simulator::Thruster& thruster = thrusters[static_cast<std::size_t>(i)];
    by_thrust.col(i) = flu_axis(thruster);
    most_rps(i) = thruster.max_speed_rps;
  }
}

Eigen::Vector3d NominalModel::allocate(const Eigen::Vector3d& forces) const {
  return speeds(by_thrust.inverse() * forces);
}

Eigen::Vector3d NominalModel::forces(const Eigen::Vector3d& speeds_rps) const {
  return by_thrust * thrusts(speeds_rps);
}

Eigen::Vector3d NominalModel::thrusts(const Eigen::Vector3d& speeds_rps) const {
  Eigen::Vector3d thrusts;
  for (Eigen::Index i = 0; i < 3; ++i) {
    thrusts(i) = simulator::thrust(thrusters[static_cast<std::size_t>(i)], speeds_rps(i));
  }
  return thrusts;
}

Eigen::Vector3d NominalModel::speeds(const Eigen::Vector3d& thrusts_n) const {
  Eigen::Vector3d speeds;
  for (Eigen::Index i = 0; i < 3; ++i) {
    speeds(i) = simulator::speed_for_thrust(thrusters[static_cast<std::size_t>(i)], thrusts_n(i));
  }
  return speeds;
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
  error.pose.z() = wrapped(reference.pose.z() - sensed.pose.z());
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

std::unique_ptr<Controller> make_pid(const NominalModel& model, bool feed_forward,
                                     const Diagnosis* diagnosis) {
  return std::make_unique<PidController>(model, feed_forward, diagnosis);
}

std::unique_ptr<Controller> make_adaptive(const NominalModel& model) {
  return std::make_unique<AdaptiveController>(model);
}

}  // namespace kelpie::lab
