// SPDX-License-Identifier: Apache-2.0
#include "lab/reckoners.hpp"

#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/navigation/dead_reckoning.hpp"
#include "model/snapshot.hpp"

namespace kelpie::lab {
namespace {

constexpr double kRenewS = 10.0;

class NominalReckoner final : public Reckoner {
 public:
  explicit NominalReckoner(NominalModel nominal) : nominal_(std::move(nominal)) {}

 protected:
  Eigen::Vector2d velocity(const Sensed& sensed) override {
    if (!sensed.silent) {
      velocity_ = sensed.velocity;
      return velocity_.head<2>();
    }
    velocity_.z() = sensed.velocity.z();
    const Eigen::Vector3d forces =
        nominal_.forces(sensed.rotors_rps) - nominal_.resistance(velocity_);
    velocity_ += kControlPeriodS * forces.cwiseQuotient(nominal_.mass);
    return velocity_.head<2>();
  }

 private:
  NominalModel nominal_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

class LearnedReckoner final : public Reckoner {
 public:
  explicit LearnedReckoner(const DynamicsModel& model) : model_(model) {}

 protected:
  Eigen::Vector2d velocity(const Sensed& sensed) override {
    renew(sensed);
    if (!reckoning_) {
      return sensed.silent ? Eigen::Vector2d::Zero() : sensed.velocity.head<2>().eval();
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    const std::array x{sensed.silent ? none : sensed.velocity(0),
                       sensed.silent ? none : sensed.velocity(1),
                       sensed.velocity(2),
                       sensed.rotors_rps(0),
                       sensed.rotors_rps(1),
                       sensed.rotors_rps(2)};
    reckoning_->update(x, sensed.time_s);
    if (!sensed.silent) {
      return sensed.velocity.head<2>();
    }
    return {reckoning_->velocity(0), reckoning_->velocity(1)};
  }

 private:
  void renew(const Sensed& sensed) {
    if (sensed.silent || sensed.time_s < next_s_ || !model_.ready()) {
      return;
    }
    next_s_ = sensed.time_s + kRenewS;
    const TrainedModel trained = model_.trained();
    if (!trained.axes.front().steady.ready()) {  // too few samples for the equations
      return;
    }
    const OpenLoop loop = open_loop(trained, OpenLoopPart::steady);
    if (reckoning_) {
      reckoning_->use(loop);
    } else {
      reckoning_.emplace(loop, DeadReckoningSettings{.step_s = kControlPeriodS, .checks = false});
    }
  }

  const DynamicsModel& model_;
  std::optional<DeadReckoning> reckoning_;
  double next_s_ = 0.0;
};

}  // namespace

Sensed Reckoner::complete(const Sensed& sensed) {
  Sensed full = sensed;
  full.velocity.head<2>() = velocity(sensed);
  if (sensed.silent) {
    const Eigen::Rotation2Dd to_world(sensed.pose.z());
    pose_.head<2>() += kControlPeriodS * (to_world * full.velocity.head<2>());
    full.pose.head<2>() = pose_.head<2>();
  }
  pose_ = full.pose;
  return full;
}

std::unique_ptr<Reckoner> make_nominal_reckoner(const NominalModel& nominal) {
  return std::make_unique<NominalReckoner>(nominal);
}

std::unique_ptr<Reckoner> make_learned_reckoner(const DynamicsModel& model) {
  return std::make_unique<LearnedReckoner>(model);
}

}  // namespace kelpie::lab
