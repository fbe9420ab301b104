// SPDX-License-Identifier: Apache-2.0
// J.-J. E. Slotine, W. Li: On the adaptive control of robot manipulators, IJRR 6(3), 1987, with the
// vehicle's planar equations in place of the manipulator's.
#include <algorithm>
#include <cmath>

#include "lab/controllers.hpp"

namespace kelpie::lab {
namespace {

constexpr int kParameters = 5;  // per axis: mass, coupling, linear and quadratic drag, a force
using Regressor = Eigen::Matrix<double, kParameters, 1>;

class AdaptiveController final : public Controller {
 public:
  explicit AdaptiveController(const NominalModel& model) : model_(model) {
    const Eigen::Vector3d& m = model.mass;
    const Eigen::Vector3d coupling(m.y(), m.x(), m.y() - m.x());
    for (int axis = 0; axis < 3; ++axis) {
      theta_.col(axis) << m(axis), coupling(axis), model.linear(axis), model.quadratic(axis), 0.0;
    }
    nominal_ = theta_;
  }

  Eigen::Vector3d update(const Reference& reference, const Sensed& sensed) override {
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
    const Eigen::Vector3d commands = model_.allocate(forces);
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
  Eigen::Matrix<double, kParameters, 3> theta_;
  Eigen::Matrix<double, kParameters, 3> nominal_;
};

}  // namespace

std::unique_ptr<Controller> make_adaptive(const NominalModel& model) {
  return std::make_unique<AdaptiveController>(model);
}

}  // namespace kelpie::lab
